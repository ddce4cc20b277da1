"""Files that are written completely or not at all, and read within bounds."""

import errno
import os
import stat
import sys

import pytest

from simulearn.errors import InputError
from simulearn.files import (
    cache_folder,
    data_folder,
    decoded,
    parse_json,
    path_from,
    read_text,
    replacing,
)

posix = pytest.mark.skipif(os.name != "posix", reason="modes and links of POSIX")
user = pytest.mark.skipif(
    not hasattr(os, "geteuid") or os.geteuid() == 0, reason="root may write anywhere"
)


def write(path, text="new"):
    with replacing(path) as temporary:
        temporary.write_text(text)


def test_a_file_is_replaced_when_it_is_complete(tmp_path):
    path = tmp_path / "a.txt"
    path.write_text("old")
    with replacing(path) as temporary:
        temporary.write_text("new")
        assert temporary.suffix == ".txt"
        assert path.read_text() == "old"
    assert path.read_text() == "new"
    assert list(tmp_path.iterdir()) == [path]


def test_an_error_leaves_the_old_file_and_nothing_else(tmp_path):
    path = tmp_path / "a.txt"
    path.write_text("old")

    def fail():
        with replacing(path) as temporary:
            temporary.write_text("half")
            raise KeyError

    with pytest.raises(KeyError):
        fail()
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]


@posix
@pytest.mark.parametrize("mask", [0o022, 0o077])
def test_a_file_has_the_access_of_any_new_file_from_the_beginning(tmp_path, monkeypatch, mask):
    before = os.umask(mask)
    monkeypatch.setattr(os, "umask", None)  # it belongs to all threads
    try:
        with replacing(tmp_path / "a") as temporary:
            assert stat.S_IMODE(temporary.stat().st_mode) == 0o666 & ~mask
            temporary.write_text("new")
    finally:
        monkeypatch.undo()
        os.umask(before)
    assert stat.S_IMODE((tmp_path / "a").stat().st_mode) == 0o666 & ~mask


def test_the_contents_are_on_the_disk_before_the_name(tmp_path, monkeypatch):
    synced = []
    real = os.fsync

    def fsync(handle):
        synced.append((os.fstat(handle).st_size, (tmp_path / "a").exists()))
        real(handle)

    monkeypatch.setattr(os, "fsync", fsync)
    write(tmp_path / "a", "12345")
    assert synced == [(5, False)]


@posix
@pytest.mark.parametrize("there", [True, False])
def test_a_link_stays_and_its_file_is_replaced(tmp_path, there):
    (tmp_path / "folder").mkdir()
    file, link = tmp_path / "folder" / "file", tmp_path / "link"
    if there:
        file.write_text("old")
    link.symlink_to(file)
    write(link)
    assert link.is_symlink()
    assert file.read_text() == "new"
    assert list((tmp_path / "folder").iterdir()) == [file]


@pytest.mark.parametrize(
    ("name", "words"),
    [
        (".", "is a folder; name a file"),
        ("none/a.json", "the folder .*none does not exist"),
        ("file/a.json", "the folder .*file is not a folder"),
        ("a" * 5000, "cannot be written"),
        ("a\0b", "is not the name of a file"),
    ],
)
def test_a_place_where_no_file_can_be_is_named(tmp_path, name, words):
    (tmp_path / "file").touch()
    with pytest.raises(InputError, match=words), replacing(tmp_path / name):
        pass


@posix
def test_a_device_is_not_replaced(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(InputError, match="is a device or a pipe"), replacing(tmp_path / "pipe"):
        pass


@user
def test_a_folder_that_may_not_be_written_is_named(tmp_path):
    tmp_path.chmod(0o500)
    try:
        with pytest.raises(InputError, match="cannot be written"), replacing(tmp_path / "a"):
            pass
    finally:
        tmp_path.chmod(0o700)


@pytest.mark.parametrize(
    "error",
    [
        OSError(errno.ENOSPC, "No space left on device"),
        OSError("Unable to write (file write failed: errno = 28, error message = 'No space')"),
    ],
)
def test_a_full_disk_is_said_in_one_line(tmp_path, error):
    with pytest.raises(InputError, match="a: cannot be written"), replacing(tmp_path / "a"):
        raise error


@pytest.mark.parametrize(
    "error",
    [
        FileNotFoundError(errno.ENOENT, "No such file or directory", "other"),
        ConnectionResetError(errno.ECONNRESET, "Connection reset by peer"),
        TimeoutError("the worker did not answer"),
    ],
)
def test_an_error_that_is_not_of_writing_keeps_its_message(tmp_path, error):
    with pytest.raises(type(error)) as raised, replacing(tmp_path / "a"):
        raise error
    assert raised.value is error
    assert not list(tmp_path.iterdir())


def test_a_text_is_read_with_its_lines(tmp_path):
    (tmp_path / "a").write_bytes("ä\r\nb\n".encode())
    assert read_text(tmp_path / "a") == "ä\nb\n"


def test_a_file_that_is_too_large_is_refused(tmp_path):
    (tmp_path / "a").write_bytes(b"x" * (2**20 + 1))
    with pytest.raises(InputError, match="a: is too large; at most 1 MiB can be read"):
        read_text(tmp_path / "a", 2**20)
    assert len(read_text(tmp_path / "a", 2**20 + 1)) == 2**20 + 1


@pytest.mark.skipif(sys.platform != "linux", reason="a file without an end")
def test_a_file_without_an_end_is_refused():
    with pytest.raises(InputError, match="/dev/zero: is too large"):
        read_text("/dev/zero", 2**20)


@pytest.mark.parametrize(
    ("name", "words"),
    [("none", "no such file"), (".", "cannot be read"), ("a\0b", "is not the name of a file")],
)
def test_what_cannot_be_read_is_named(tmp_path, name, words):
    with pytest.raises(InputError, match=words):
        read_text(tmp_path / name)


def test_a_path_is_seen_from_a_folder_unless_it_is_on_another_drive(tmp_path, monkeypatch):
    (tmp_path / "a").mkdir()
    assert path_from(tmp_path / "a", tmp_path / "b" / "c.stl") == "../b/c.stl"

    def other_drive(path, start):
        raise ValueError("path is on mount 'D:', start on mount 'C:'")

    monkeypatch.setattr("os.path.relpath", other_drive)
    whole = (tmp_path / "c.stl").resolve().as_posix()
    assert path_from(tmp_path / "a", tmp_path / "c.stl") == whole


def test_what_is_not_text_is_named(tmp_path):
    (tmp_path / "a").write_bytes(b"\xff\xfd")
    with pytest.raises(InputError, match="is not UTF-8 text"):
        read_text(tmp_path / "a")


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "utf-32"])
def test_a_byte_order_mark_says_the_encoding_and_is_no_text(tmp_path, encoding):
    (tmp_path / "a").write_bytes('a = "é"\r\nb\r'.encode(encoding))
    assert read_text(tmp_path / "a") == 'a = "é"\nb\n'


def test_a_mark_that_came_with_the_text_is_no_json():
    assert parse_json("\ufeff[1]") == [1]
    assert decoded(b"\xff\xfe") == ""


def test_a_user_without_a_home_has_no_folders(monkeypatch):
    import platformdirs

    def nowhere(*_args, **_more):
        raise RuntimeError("could not determine the home directory")

    for name in ("user_cache_dir", "user_data_dir"):
        monkeypatch.setattr(platformdirs, name, nowhere)
    assert cache_folder() is None
    assert data_folder() is None


@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16"])
def test_every_file_of_a_person_may_begin_with_a_byte_order_mark(tmp_path, encoding):
    """Editors of Windows write one, and end lines with two characters."""
    from simulearn.dataset import read_config
    from simulearn.fabricate import load_printer
    from simulearn.learn.config import read_config as read_training
    from simulearn.material import read_material
    from simulearn.material.reading import HERE

    def saved(name, text):
        path = tmp_path / name
        path.write_bytes(text.replace("\n", "\r\n").encode(encoding))
        return path

    assert load_printer(saved("lab.toml", 'base = "ender-3"\ntitle = "Lab"\n')).title == "Lab"
    assert read_config(saved("set.toml", 'name = "tiny"\ntrials = 2\n')).trials == 2
    beams = 'name = "b"\nkind = "beams"\ndata = "x.h5"\n[law]\nupdates = 1\n'
    assert read_training(saved("train.toml", beams)).name == "b"
    pla = (HERE / "pla-hot-water.toml").read_text("utf-8")
    assert read_material(saved("pla.toml", pla)) == read_material(HERE / "pla-hot-water.toml")
