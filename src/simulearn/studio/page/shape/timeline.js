// The order of the frames in time: how playing goes on, and what a moment is called.

import { LAST } from "./topology.js";

export const PASS = 4; // s from flat to after creep
export const HOLD = 0.9; // s at the end before it starts anew
const NEAR = 0.14; // frames: a slider this near to a frame is on it

/** Return {clock, frame, playing} after `seconds` more of playing. clock: s since frame 0. */
export function advance(clock, seconds, loop) {
  const next = clock + seconds;
  if (next < PASS) return { clock: next, frame: (next / PASS) * LAST, playing: true };
  if (!loop) return { clock: PASS, frame: LAST, playing: false };
  if (next < PASS + HOLD) return { clock: next, frame: LAST, playing: true };
  return { clock: 0, frame: 0, playing: true };
}

/** Return the clock at which playing starts at a frame: from the end it starts anew. */
export function clockAt(frame) {
  return frame >= LAST ? 0 : (frame / LAST) * PASS;
}

/** Return the frame of a slider's value: the nearest one if it is close. */
export function snapFrame(value) {
  const nearest = Math.round(value);
  return Math.abs(value - nearest) < NEAR ? nearest : value;
}

/** Return the next frame in a direction (+1, -1) from a moment that may lie between two. */
export function nextFrame(frame, direction) {
  const next = direction > 0 ? Math.floor(frame + 1e-6) + 1 : Math.ceil(frame - 1e-6) - 1;
  return Math.min(LAST, Math.max(0, next));
}

/** Return { key, values } of what a moment is called: the name of a string and its numbers. */
export function momentOf(frame) {
  if (frame <= 0.005) return { key: "flat", values: {} };
  if (frame >= LAST - 0.005) return { key: "crept", values: {} };
  if (frame > LAST - 1 + 0.005) return { key: "creeping", values: {} };
  return { key: "released", values: { percent: Math.round(frame * 10) } };
}
