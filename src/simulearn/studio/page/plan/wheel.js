// The wheel over the plan. A mouse's wheel zooms; two fingers on a trackpad move the plan, and
// pinched (the browser says: with ctrl) they zoom. Over a selected beam the mouse's wheel changes the
// actuator, with alt over any beam.

const NOTCH = 50; // px; trackpads send less at once when they begin, wheels send 100 or 120
const ZOOM = { wheel: 0.0016, pinch: 0.01 }; // of the logarithm of the scale, per px
const LINE = 16; // px of a line, where the browser counts lines
const PAUSE = 350; // ms; a wheel that rests as long begins anew
const STEP = 60; // px of a wheel for a quarter of an actuator

/** Return a wheel event's movement in pixels [dx, dy]. */
export function wheelPixels({ deltaX, deltaY, deltaMode }) {
  const unit = deltaMode === 1 ? LINE : deltaMode === 2 ? 400 : 1;
  return [deltaX * unit, deltaY * unit];
}

/** Return whether an event that begins a movement is of a wheel with notches. */
export function isNotched({ deltaX, deltaY, deltaMode }) {
  return deltaMode !== 0 || (deltaX === 0 && Math.abs(deltaY) >= NOTCH);
}

/** Return what a wheel does that begins: "zoom", "pinch", "pan", "across" or "actuator".
 *
 * beam: null, "plain" or "selected": the beam under the pointer.
 */
export function wheelUse(event, beam) {
  if (event.ctrlKey || event.metaKey) return "pinch";
  if (event.altKey && beam) return "actuator";
  if (event.shiftKey) return "across";
  if (!isNotched(event)) return "pan";
  return beam === "selected" ? "actuator" : "zoom";
}

/** Collects wheel events; `take` gives once per frame what they amount to. */
export class Wheel {
  constructor() {
    this.use = null;
    this.last = -Infinity;
    this.moved = [0, 0];
    this.rest = 0; // px not yet used for a step of an actuator
  }

  /** Add an event at a time in ms; what is under the pointer counts when a movement begins. */
  add(event, time, beam) {
    const zooms = event.ctrlKey || event.metaKey;
    if (time - this.last > PAUSE || this.use === null || zooms !== (this.use === "pinch")) {
      this.use = wheelUse(event, beam());
      this.rest = 0;
    }
    this.last = time;
    const [dx, dy] = wheelPixels(event);
    this.moved = [this.moved[0] + dx, this.moved[1] + dy];
  }

  /** Return {use, factor} to zoom, {use, by: [dx, dy]} to pan or {use, steps} of the actuator. */
  take() {
    const [dx, dy] = this.moved;
    this.moved = [0, 0];
    if (this.use === "pan") return { use: "pan", by: [-dx, -dy] };
    if (this.use === "across") return { use: "pan", by: [-(dx || dy), 0] };
    if (this.use === "actuator") {
      this.rest -= dy || dx; // alt or shift may turn the wheel's direction
      const steps = Math.trunc(this.rest / STEP);
      this.rest -= steps * STEP;
      return { use: "actuator", steps: Math.sign(steps) };
    }
    return { use: "zoom", factor: Math.exp(-dy * (this.use === "pinch" ? ZOOM.pinch : ZOOM.wheel)) };
  }
}
