"""Films: what ffprobe says of them, what they show, and what happens where ffmpeg is not."""

import json
import os
import shutil
import subprocess

import numpy as np
import pytest
from PIL import Image

import synthetic
from simulearn import outputs
from simulearn.errors import CancelledError, InputError
from simulearn.show import animate
from simulearn.show.video import write_video

RESULT = synthetic.result(synthetic.square_grid((1, 1)), solid=False)


def probed(path):
    command = ["ffprobe", "-v", "error", "-count_frames", "-show_streams", "-show_format",
               "-of", "json", str(path)]  # fmt: skip
    found = json.loads(subprocess.run(command, check=True, capture_output=True).stdout)
    (stream,) = found["streams"]
    return stream, found["format"]


def picture(path, time, tmp_path):
    command = ["ffmpeg", "-v", "error", "-y", "-ss", f"{time}", "-i", str(path),
               "-frames:v", "1", str(tmp_path / "one.png")]  # fmt: skip
    subprocess.run(command, check=True)
    return np.asarray(Image.open(tmp_path / "one.png").convert("RGB")).astype(float)


@pytest.mark.parametrize(("ending", "codec"), [(".mp4", "h264"), (".webm", "vp9")])
def test_films_play_everywhere_and_show_what_the_gif_shows(tmp_path, ffmpeg, ending, codec):
    path = tmp_path / f"a{ending}"
    outputs.write(RESULT, path)
    stream, whole = probed(path)
    assert (stream["codec_name"], stream["pix_fmt"]) == (codec, "yuv420p")
    assert stream["width"] % 2 == stream["height"] % 2 == 0
    assert stream["width"] == pytest.approx(936, abs=2)
    assert stream["r_frame_rate"] == "25/1"
    assert int(stream["nb_read_frames"]) == 35 + 54 + 35
    assert float(whole["duration"]) == pytest.approx(4.96, abs=0.1)
    comment = {key.lower(): text for key, text in whole["tags"].items()}["comment"]
    assert comment.startswith("engine synthetic")
    animate(RESULT, tmp_path / "a.gif")
    with Image.open(tmp_path / "a.gif") as gif:
        for seconds, number in ((0.5, 0), (4.5, gif.n_frames - 1)):
            gif.seek(number)
            shown = picture(path, seconds, tmp_path)
            size = (gif.width, gif.height)
            small = np.asarray(Image.fromarray(shown.astype(np.uint8)).resize(size))
            gap = abs(small - np.asarray(gif.convert("RGB")).astype(float))
            assert gap.mean() < 3
    begin, end = picture(path, 0.5, tmp_path), picture(path, 4.5, tmp_path)
    assert abs(begin - end).mean() > 1


def test_odd_sizes_are_made_even(tmp_path, ffmpeg):
    write_video([np.full((51, 33, 3), 200, np.uint8)] * 3, tmp_path / "a.mp4")
    stream, _ = probed(tmp_path / "a.mp4")
    assert (stream["width"], stream["height"]) == (34, 52)
    assert abs(picture(tmp_path / "a.mp4", 0, tmp_path) - 200).max() < 4


class After:
    def __init__(self, left):
        self.left = left

    def is_set(self):
        self.left -= 1
        return self.left < 0


@pytest.mark.parametrize("ending", [".gif", ".mp4", ".webm"])
def test_a_film_can_be_stopped(tmp_path, ffmpeg, ending):
    with pytest.raises(CancelledError):
        outputs.write(RESULT, tmp_path / f"a{ending}", After(5))
    assert not [*tmp_path.iterdir()]


def test_without_ffmpeg_one_line_says_what_to_install(tmp_path, monkeypatch):
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.delenv("IMAGEIO_FFMPEG_EXE", raising=False)
    monkeypatch.setattr("simulearn.show.video.find_spec", lambda name: None)
    with pytest.raises(InputError, match=r"apt install ffmpeg.*pip install imageio-ffmpeg") as info:
        outputs.check([tmp_path / "a.MP4"])
    assert "\n" not in str(info.value)
    assert info.value.code == "package-missing"


def test_ffmpeg_is_found_where_imageio_looks_for_it(tmp_path, monkeypatch, ffmpeg):
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.setenv("IMAGEIO_FFMPEG_EXE", ffmpeg)
    outputs.check([tmp_path / "a.webm"])


@pytest.mark.skipif(os.name == "nt", reason="a script of a shell")
def test_what_ffmpeg_says_is_reported(tmp_path, monkeypatch):
    fake = tmp_path / "ffmpeg"
    fake.write_text("#!/bin/sh\necho \"Unknown encoder 'libx264'\" >&2\nexit 1\n")
    fake.chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path}{os.pathsep}{os.environ['PATH']}")
    monkeypatch.delenv("IMAGEIO_FFMPEG_EXE", raising=False)
    assert shutil.which("ffmpeg") == str(fake)
    path = tmp_path / "a.mp4"
    path.write_bytes(b"old")
    with pytest.raises(InputError, match="Unknown encoder 'libx264'"):
        write_video(iter([np.zeros((1000, 1000, 3), np.uint8)] * 20), path)
    assert path.read_bytes() == b"old"
    assert {file.name for file in tmp_path.iterdir()} == {"ffmpeg", "a.mp4"}
