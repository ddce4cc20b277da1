"""A network on the half-beams of a grid: its features, messages and outputs, frame by frame.

What it computes is `corrector.outputs`: the mean over a design and its mirror image, which are one
batch of rows here.
"""

from math import atan2, cos, sin
from typing import Any, NamedTuple

import numpy as np

from simulearn.learn.equilibrium.kernels.layers import activate, add_rows, product
from simulearn.native import native

Array = Any

MATERIAL = 17  # where the features of the material begin
PLAIN = 25  # features besides twists and directions
CURL = 6  # which feature of the material is its own curl, which is upwards
WAVES = 5  # 1, cos, sin, cos 2, sin 2 of the angle
HALF = np.float32(0.5)


class Layers(NamedTuple):
    """Weights of a network, (in, out), and what its outputs mean.

    Attributes:
        first, first_bias, second, second_bias: of the encoder.
        into, into_bias: (rounds, width, message) messages.
        own, other, around, update_bias: (rounds, width, width) twice, (rounds, 10 message, width),
            (rounds, width): of an update, by what the half itself, its beam's other half, and the
            halves around it say.
        third, third_bias, last, last_bias: of the decoder.
        mirror: (features,) signs of the features in a mirrored design.
        mirror_order, mirror_sign, flip_order, flip_sign: (outputs,).
        size: (outputs,) usual size.
        twist: (6,) usual size of twists.
        flip: (6,) signs of twists where a half is upside down.
    """

    first: Array
    first_bias: Array
    second: Array
    second_bias: Array
    into: Array
    into_bias: Array
    own: Array
    other: Array
    around: Array
    update_bias: Array
    third: Array
    third_bias: Array
    last: Array
    last_bias: Array
    mirror: Array
    mirror_order: Array
    mirror_sign: Array
    flip_order: Array
    flip_sign: Array
    size: Array
    twist: Array
    flip: Array


@native(entry=False)
def set_features(
    x: Array, layers: Any, geometry: Any, ends: Array, fixed: int, ratio: Array, valence: Array,
    R: Array, twists: Array, s: float, gravity: float, scale: float, signs: Array, strain: Array,
) -> None:  # fmt: skip
    """Set the rows of all halves (2 B), then of the mirrored design, in one frame."""
    beams, joints = len(ratio), len(valence)
    for end in range(2):
        for b in range(beams):
            row = x[end * beams + b]
            size, sign = abs(ratio[b]), (-1.0 if ratio[b] < 0 else 1.0)
            joint, other = ends[end, b], ends[1 - end, b]
            length = geometry.length[b] / scale
            held = 1.0 if joint == fixed else 0.0
            far_held = 1.0 if other == fixed else 0.0
            row[0] = length / 50 - 1
            row[1] = size
            row[2] = 1.0 if size == 0 else 0.0
            row[3] = (1 - size) * length / 40 - 0.5
            row[4] = size * length / 40 - 0.5
            row[5] = geometry.reach[end, b] / scale / 2 - 2
            row[6] = geometry.skew[end, b] / scale / 3
            row[7] = geometry.reach[1 - end, b] / scale / 2 - 2
            row[8] = geometry.skew[1 - end, b] / scale / 3
            row[9] = held
            row[10] = held * sign
            row[11] = far_held
            row[12] = far_held * sign
            row[13] = geometry.area[joint] / (scale * scale) / 30 - 2
            row[14] = valence[joint] - 3.0
            row[15] = 2 * s * strain[b] - 1
            row[16] = (gravity - 1) * 4
            for k in range(len(signs)):
                row[MATERIAL + k] = signs[k] * sign if k == CURL else signs[k]
            for k in range(6):
                flip = layers.flip[k] if sign < 0 else 1.0
                usual = layers.twist[k] * (scale if k < 3 else 1.0)
                row[PLAIN + k] = twists[end, b, k] / usual * flip
                row[PLAIN + 6 + k] = twists[1 - end, b, k] / usual * flip
            frame = geometry.frame[end, b]
            for k in range(3):
                down = sign if k == 2 else 1.0
                above = 0.0
                for m in range(3):
                    above += frame[3 * m + k] * R[joint, 6 + m]
                middle = R[joints + b, 6 + k]
                if end == 1 and k < 2:
                    middle = -middle
                row[PLAIN + 12 + k] = above * down
                row[PLAIN + 15 + k] = middle * down
    for i in range(2 * beams):
        for k in range(x.shape[1]):
            x[2 * beams + i, k] = x[i, k] * layers.mirror[k]


@native(entry=False)
def set_waves(waves: Array, geometry: Any, ratio: Array) -> None:
    """Set 1, cos a, sin a, cos 2 a, sin 2 a and the sign of the actuator for all rows."""
    beams = len(ratio)
    for mirrored in range(2):
        for end in range(2):
            for b in range(beams):
                frame = geometry.frame[end, b]
                angle = atan2(frame[3], frame[0])
                if mirrored == 1:
                    angle = -angle
                wave = waves[(2 * mirrored + end) * beams + b]
                wave[0] = 1.0
                for k in range(1, 3):
                    wave[2 * k - 1] = cos(k * angle)
                    wave[2 * k] = sin(k * angle)
                wave[WAVES] = -1.0 if ratio[b] < 0 else 1.0


@native(entry=False, fastmath={"contract"})
def set_received(
    received: Array, messages: Array, length: int, waves: Array, ends: Array, total: Array
) -> None:
    """Find what the other halves at the same joint say.

    Args:
        received: (4 B, 2 WAVES length) to set.
        messages: (4 B, at least length).
        length: of a message.
        waves: (4 B, WAVES + 1) see `set_waves`.
        ends: (2, B) joint of each half.
        total: (2 J, 2 WAVES length) workspace: sums over joints in fixed axes.
    """
    beams = ends.shape[1]
    joints = len(total) // 2
    for i in range(len(total)):
        for k in range(total.shape[1]):
            total[i, k] = 0.0
    for i in range(4 * beams):
        side, b = i // beams, i % beams
        sums, wave, message = total[ends[side % 2, b] + joints * (side // 2)], waves[i], messages[i]
        for w in range(WAVES):
            plain, signed = wave[w], wave[w] * wave[WAVES]
            to = sums[2 * w * length : 2 * (w + 1) * length]
            for k in range(length):
                to[k] += plain * message[k]
                to[length + k] += signed * message[k]
    for i in range(4 * beams):
        side, b = i // beams, i % beams
        sums, wave, message = total[ends[side % 2, b] + joints * (side // 2)], waves[i], messages[i]
        sign, row = wave[WAVES], received[i]
        for part in range(2):
            factor = HALF if part == 0 else HALF * sign
            at = part * length
            own = HALF  # of its own message: a factor's square is 1
            to, constant = row[at : at + length], sums[at : at + length]
            for k in range(length):
                to[k] = factor * constant[k] - own * message[k]
            for h in range(1, 3):
                c, s = wave[2 * h - 1] * factor, wave[2 * h] * factor
                first = (4 * h - 2) * length + at
                second = first + 2 * length
                one, two = sums[first : first + length], sums[second : second + length]
                turned, back = row[first : first + length], row[second : second + length]
                for k in range(length):
                    turned[k] = c * one[k] + s * two[k] - own * message[k]
                for k in range(length):
                    back[k] = c * two[k] - s * one[k]


@native()
def outputs(
    layers: Any, geometry: Any, ends: Array, fixed: int, ratio: Array, valence: Array, R: Array,
    twists: Array, released: Array, gravity: Array, scale: float, signs: Array, strain: Array,
    begin: int, out: Array,
) -> None:  # fmt: skip
    """Set the outputs of a network for all halves in some frames.

    Args:
        layers: weights.
        geometry: the flat grid.
        ends: (2, B) joint of each half.
        fixed: the fixed joint.
        ratio: (B,) signed actuator ratios.
        valence: (J,) halves at each joint.
        R: (F, J + B, 9) rotations of joints and middles.
        twists: (F, 2, B, 6) of halves from their rest by the section model.
        released: (F,) fraction.
        gravity: (F,) multiple.
        scale: of lengths.
        signs: what the networks see of the material.
        strain: (B,) released strain of the beams over that of the reference.
        begin: the first frame that counts.
        out: (F, 2, B, outputs) to set.
    """
    beams = len(ratio)
    rows, width, message = 4 * beams, layers.second.shape[1], layers.into.shape[2]
    count = layers.last.shape[1]
    x = np.zeros((rows, layers.first.shape[0]), np.float32)
    a, b = np.zeros((rows, width), np.float32), np.zeros((rows, width), np.float32)
    c = np.zeros((rows, width), np.float32)
    received = np.zeros((rows, 2 * WAVES * message), np.float32)
    messages = np.zeros((rows, message), np.float32)
    ends_of = np.zeros((rows, count), np.float32)
    waves = np.zeros((rows, WAVES + 1), np.float32)
    total = np.zeros((2 * len(valence), 2 * WAVES * message), np.float32)
    powers, scales = np.zeros(width + message, np.float32), np.zeros(width + message, np.float32)
    bits = scales.view(np.int32)
    set_waves(waves, geometry, ratio)
    for f in range(begin, len(released)):
        set_features(
            x, layers, geometry, ends, fixed, ratio, valence, R[f], twists[f], released[f],
            gravity[f], scale, signs, strain,
        )  # fmt: skip
        layered = 4 + 2 * len(layers.into)
        for layer in range(layered):  # one place for each kernel: what is called is compiled in
            r = layer // 2 - 1
            sending = 2 <= layer < layered - 2 and layer % 2 == 0
            update = 2 <= layer < layered - 2 and layer % 2 == 1
            source, target, bias = b, c, layers.update_bias[0]
            matrix = layers.second
            if layer == 0:
                source, target, matrix, bias = x, a, layers.first, layers.first_bias
            elif layer == 1:
                source, target, bias = a, b, layers.second_bias
            elif layer == layered - 2:
                target, matrix, bias = a, layers.third, layers.third_bias
            elif layer == layered - 1:
                source, target, matrix, bias = a, ends_of, layers.last, layers.last_bias
            elif sending:
                target, matrix, bias = messages, layers.into[r], layers.into_bias[r]
            else:
                matrix, bias = layers.own[r], layers.update_bias[r]
            product(source, matrix, target)
            if update:
                product(b, layers.other[r], a)
                for i in range(rows):
                    other = i + beams if (i // beams) % 2 == 0 else i - beams
                    for k in range(width):
                        c[i, k] += a[other, k]
                product(received, layers.around[r], a)
                for i in range(rows):
                    for k in range(width):
                        c[i, k] += a[i, k]
            add_rows(target, bias)
            if layer < layered - 1:
                activate(target, target.shape[1], powers, bits, scales)
            if sending:
                set_received(received, messages, message, waves, ends, total)
            if update:
                for i in range(rows):
                    for k in range(width):
                        b[i, k] += c[i, k]
        both = np.zeros(count, np.float32)
        for end in range(2):
            for m in range(beams):
                here, there = ends_of[end * beams + m], ends_of[(2 + end) * beams + m]
                for k in range(count):
                    both[k] = HALF * (
                        here[k] + there[layers.mirror_order[k]] * layers.mirror_sign[k]
                    )
                target = out[f, end, m]
                for k in range(count):
                    if ratio[m] < 0:
                        target[k] = (
                            both[layers.flip_order[k]] * layers.flip_sign[k] * layers.size[k]
                        )
                    else:
                        target[k] = both[k] * layers.size[k]
