// From pointer events to the tool in use. Moves are read once per frame. The left button is the
// tool's; the middle one, or the left one with the space bar, moves the plan; two fingers move and zoom.

import { pan, pinch, toPlan, zoomAt } from "./camera.js";
import { beamWidth, editor, reach, setCamera } from "./editor.js";
import { isSelected, partAt } from "./hit.js";
import { stepBeams } from "./actions.js";
import { currentTool } from "./tools/tools.js";
import { Wheel } from "./wheel.js";
import { state } from "../store.js";

const CLICK = 3; // px; movements below are clicks
const TOUCH_CLICK = 8; // px, of a finger
const LONG = 550; // ms that a finger rests to open the menu

/** Listen to the pointer over an <svg>; returns a function that ends this. */
export function listen(svg, { openMenu, isSpaceDown }) {
  const fingers = new Map(); // pointerId -> screen place, of touches
  const wheel = new Wheel();
  let press = null; // { id, screen, last, moved, far, pans, empty } while a button or finger is down
  let waiting = null; // the last move not yet read
  let pinching = null; // places of two fingers when last read
  let frame = 0;
  let long = 0;

  const screenOf = ({ clientX, clientY }) => {
    const { left, top } = svg.getBoundingClientRect();
    return [clientX - left, clientY - top];
  };

  const read = (event) => {
    const screen = screenOf(event);
    return {
      screen, point: toPlan(editor.camera, screen), touch: event.pointerType === "touch",
      shift: event.shiftKey, alt: event.altKey,
    };
  };

  /** Remember where the pointer is; null: not over the plan. */
  const point = (pointer) => {
    editor.pointer = pointer;
    state.pointer = pointer?.point ?? null;
  };

  const plan = () => {
    frame ||= requestAnimationFrame(flush);
  };

  function flush() {
    cancelAnimationFrame(frame);
    frame = 0;
    const turned = wheel.take();
    if (turned.use === "actuator" && turned.steps) stepBeams(turned.steps, wheelBeams());
    if (turned.use === "pan" && (turned.by[0] || turned.by[1])) setCamera(pan(editor.camera, turned.by));
    if (turned.use === "zoom" && turned.factor !== 1 && editor.pointer)
      setCamera(zoomAt(editor.camera, editor.pointer.screen, turned.factor));
    const event = waiting;
    waiting = null;
    if (pinching && fingers.size === 2) {
      const now = [...fingers.values()];
      setCamera(pinch(editor.camera, pinching, now));
      pinching = now;
      return;
    }
    if (event) moved(event);
    else if (editor.pointer && turned.use) {
      const { screen } = editor.pointer;
      point({ ...editor.pointer, point: toPlan(editor.camera, screen) });
    }
  }

  function moved(event) {
    const pointer = read(event);
    point(pointer);
    if (!press) {
      if (event.buttons === 0) currentTool().hover(pointer);
      return;
    }
    if (event.pointerId !== press.id) return;
    const [dx, dy] = [pointer.screen[0] - press.last[0], pointer.screen[1] - press.last[1]];
    if (!press.moved && farFrom(press.screen, pointer.screen) < (pointer.touch ? TOUCH_CLICK : CLICK)) return;
    press.moved = true;
    clearTimeout(long);
    press.last = pointer.screen;
    if (press.pans) setCamera(pan(editor.camera, [dx, dy]));
    else currentTool().drag(pointer);
  }

  function down(event) {
    Object.assign(editor, { menu: null, keys: false, pressed: true });
    const pointer = read(event);
    point(pointer);
    if (pointer.touch) {
      fingers.set(event.pointerId, pointer.screen);
      if (fingers.size === 2) {
        // A second finger: what the first began is taken back, both move the plan.
        clearTimeout(long);
        currentTool().cancel();
        press = null;
        pinching = [...fingers.values()];
        return;
      }
      if (fingers.size > 2) return;
    }
    if (event.button === 2 || press) return;
    svg.setPointerCapture(event.pointerId);
    const part = partAt(state.document.grid, pointer.point, reach(pointer.touch), beamWidth());
    // A finger on an empty place moves the plan, but for Draw; a long press opens the menu.
    const empty = pointer.touch && !part && state.tool !== "draw";
    const pans = event.button === 1 || isSpaceDown() || empty;
    const { screen } = pointer;
    press = { id: event.pointerId, screen, last: screen, moved: false, far: false, pans, empty };
    editor.panning = pans && !empty;
    // Also without the mouse events that browsers make of touches, which would take the focus.
    if (pans || pointer.touch) event.preventDefault();
    if (!pans) currentTool().press(pointer);
    if (!svg.contains(document.activeElement)) svg.focus({ preventScroll: true });
    const held = press;
    if (pointer.touch && state.tool === "select") long = setTimeout(() => rested(held, part), LONG);
  }

  /** Open the menu where a finger has rested; moves that a slow page has yet to see come first. */
  function rested(held, part) {
    requestAnimationFrame(() => requestAnimationFrame(() => {
      if (press !== held || held.far) return;
      currentTool().cancel();
      press = null;
      openMenu(held.screen, part);
    }));
  }

  function move(event) {
    if (event.pointerType === "touch" && fingers.has(event.pointerId))
      fingers.set(event.pointerId, screenOf(event));
    if (press?.id === event.pointerId) press.far ||= farFrom(press.screen, screenOf(event)) >= TOUCH_CLICK;
    waiting = event;
    plan();
  }

  function up(event) {
    clearTimeout(long);
    editor.pressed = false;
    const two = pinching !== null;
    fingers.delete(event.pointerId);
    if (fingers.size < 2) pinching = null;
    if (two || !press || event.pointerId !== press.id) return;
    waiting = event;
    flush();
    const ended = press;
    press = null;
    editor.panning = false;
    const pointer = read(event);
    if (!ended.pans) currentTool().release({ ...pointer, moved: ended.moved });
    else if (ended.empty && !ended.moved) {
      // A tap on an empty place: what a click there does.
      currentTool().press(pointer);
      currentTool().release({ ...pointer, moved: false });
    }
    if (pointer.touch) {
      point(null);
      currentTool().leave();
    }
  }

  function cancelled(event) {
    editor.pressed = false;
    clearTimeout(long);
    fingers.delete(event.pointerId);
    pinching = null;
    if (press && !press.pans) currentTool().cancel();
    press = null;
    editor.panning = false;
  }

  function leave() {
    if (press) return;
    waiting = null;
    point(null);
    currentTool().leave();
  }

  function turn(event) {
    event.preventDefault();
    point(read(event));
    wheel.add(event, event.timeStamp, () => {
      const part = partUnderPointer();
      if (part?.beam === undefined || state.tool === "draw") return null;
      return isSelected(state.selection, part) ? "selected" : "plain";
    });
    plan();
  }

  function partUnderPointer() {
    return editor.pointer && partAt(state.document.grid, editor.pointer.point, reach(false), beamWidth());
  }

  /** Return the beams that the wheel changes: all selected ones where the pointer is on one of them. */
  function wheelBeams() {
    const part = partUnderPointer();
    if (part?.beam === undefined) return [];
    return isSelected(state.selection, part) ? state.selection.beams : [part.beam];
  }

  const events = {
    pointerdown: down, pointermove: move, pointerup: up, pointercancel: cancelled,
    pointerleave: leave, wheel: turn,
  };
  for (const [name, react] of Object.entries(events)) svg.addEventListener(name, react, { passive: false });
  return () => {
    cancelAnimationFrame(frame);
    clearTimeout(long);
    for (const [name, react] of Object.entries(events)) svg.removeEventListener(name, react);
  };
}

function farFrom([ax, ay], [bx, by]) {
  return Math.hypot(ax - bx, ay - by);
}
