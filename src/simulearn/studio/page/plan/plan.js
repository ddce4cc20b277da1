// The plan: the flat grid seen from above, where it is drawn and changed.

import { h, onBeforeUnmount, onMounted, watch } from "/libraries/vue.js";
import { select, state } from "../store.js";
import { t } from "../text/text.js";
import {
  canPaste, copySelection, duplicateSelection, flipBeams, mirrorSelection, moveFocus, nudge, paste, redoLast,
  removeSelection, rotateSelection, selectAll, setBeams, stepBeams, undoLast, useTool, hasSelection,
} from "./actions.js";
import { anyVisible, pan, sizeScale, toPlan, toScreen } from "./camera.js";
import { beamWidth, clearMarks, editor, fitAll, reach, setElement } from "./editor.js";
import { direction, placeOf, tabStop } from "./focus.js";
import { Grid, ScaleBar } from "./grid.js";
import { isSelected, only, partAt, toggled } from "./hit.js";
import { command, listenKeys, nudgeStep } from "./keys.js";
import { Marks } from "./marks.js";
import { Menu, openMenu } from "./menu.js";
import { Over, Places, Under } from "./overlay.js";
import { Parts } from "./parts.js";
import { listen } from "./pointer.js";
import { Popover } from "./popover.js";
import { Readout } from "./readout.js";
import { Toolbar, Zooms } from "./toolbar.js";
import { currentTool, TOOLS } from "./tools/tools.js";

export const Plan = {
  setup() {
    let section = null;
    let svg = null;
    let space = null; // { used } while the space bar is down: whether it moved the plan
    const ends = [];

    onMounted(() => {
      setElement(svg);
      const sized = new ResizeObserver(([{ contentRect: { width, height } }]) => resize(width, height));
      sized.observe(svg);
      ends.push(
        () => sized.disconnect(),
        listen(svg, { openMenu, isSpaceDown: useSpace }),
        listenKeys(section, react),
      );
      const released = (event) => {
        if (event.code !== "Space" || !space) return;
        const { used } = space;
        space = null;
        editor.grab = false;
        if (!used && svg.contains(event.target)) pick(event);
      };
      document.addEventListener("keyup", released);
      ends.push(() => document.removeEventListener("keyup", released));
    });
    onBeforeUnmount(() => {
      currentTool().cancel();
      for (const end of ends) end();
    });

    watch(() => state.tool, (now, before) => {
      if (before === "draw") TOOLS.draw.finish();
      else TOOLS[before]?.cancel();
      currentTool().enter?.();
      state.hover = null;
    });
    watch(() => state.document, fitNew);
    watch(() => state.placed, () => {
      clearMarks();
      editor.popover = null;
      fitAll();
    });

    /** Return whether the space bar is down; then it does not select when it is released. */
    function useSpace() {
      if (space) space.used = true;
      return space !== null;
    }

    /** Run what a key stands for; return whether it was used. */
    function react(event) {
      editor.keys = true;
      const onPart = svg.contains(event.target) || event.target === document.body;
      if (event.key === " " && onPart) {
        space ??= { used: false };
        editor.grab = true;
        return true;
      }
      const inButton = event.target.closest?.("button");
      const pressesButton = inButton && (event.key === "Enter" || event.key === "Tab");
      if (!pressesButton && currentTool().key(event)) return true;
      if (event.key === "Enter" && svg.contains(event.target)) return pick(event);
      const name = command(event);
      if (!name || (inButton && (name === "arrow" || name === "focus"))) return false;
      if (name === "paste" && !canPaste()) return false; // the page may open what is pasted
      return run(name, event);
    }

    function pick(event) {
      const part = tabStop(state.document.grid, editor.focus);
      if (!part) return false;
      if (event.shiftKey) select(toggled(state.selection, part));
      else select(isSelected(state.selection, part) ? {} : only(part));
      if (part.beam !== undefined && isSelected(state.selection, part)) editor.popover = part;
      return true;
    }

    function menuAtFocus() {
      const part = tabStop(state.document.grid, editor.focus);
      const place = placeOf(state.document.grid, part) ?? [0, 0];
      openMenu(toScreen(editor.camera, place), part);
    }

    const onContextmenu = (event) => {
      event.preventDefault();
      // Keys and fingers open the menu elsewhere.
      if (event.pointerType ? event.pointerType !== "mouse" : event.button !== 2) return;
      if (state.tool === "draw" && editor.line?.fixed) return currentTool().finish();
      const { left, top } = svg.getBoundingClientRect();
      const screen = [event.clientX - left, event.clientY - top];
      const point = toPlan(editor.camera, screen);
      currentTool().cancel();
      openMenu(screen, partAt(state.document.grid, point, reach(false), beamWidth()));
    };

    const onFocusin = ({ target }) => {
      const part = target.closest?.("[role=option]");
      if (!part) return;
      const { joint, beam } = part.dataset;
      editor.focus = joint !== undefined ? { joint: Number(joint) } : { beam: Number(beam) };
    };

    function run(name, event) {
      if (name === "arrow" || name === "focus") {
        if (name === "focus" || !hasSelection()) moveFocus(event.key);
        else nudge(direction(event.key).map((x) => x * nudgeStep(event)));
        return true;
      }
      if (name === "menu") {
        menuAtFocus();
        return true;
      }
      const [verb, value] = name.split(" ");
      COMMANDS[verb](value);
      return true;
    }

    return () => h("section", {
      class: ["plan", `tool-${state.tool}`, { keys: editor.keys }], "aria-label": t("plan.title"),
      ref: (el) => {
        section = el;
      },
    }, [
      h("svg", {
        class: ["plan-canvas", { grab: editor.grab, panning: editor.panning, dragging: editor.dragging }],
        ...list(), "aria-label": t("plan.parts"), onContextmenu, onFocusin,
        ref: (el) => {
          svg = el;
        },
      }, [h(Grid), h(World)]),
      h(Empty), h(Toolbar), h(Hint), h(Zooms), h(ScaleBar), h(Readout), h(Popover), h(Menu), h(Message),
    ]);
  },
};

/** The plan is a list of joints and beams to choose from; without any it is but a place to draw in. */
function list() {
  if (state.document.grid.joints.length === 0) return { role: "group", tabindex: 0 };
  return { role: "listbox", "aria-multiselectable": "true", tabindex: -1 };
}

const COMMANDS = {
  select: () => useTool("select"),
  draw: () => useTool("draw"),
  split: () => useTool("split"),
  fix: () => useTool("fix"),
  fit: fitAll,
  longer: () => stepBeams(1),
  shorter: () => stepBeams(-1),
  quarters: (count) => setBeams(Number(count) / 4),
  flip: () => flipBeams(),
  delete: removeSelection,
  mirror: mirrorSelection,
  rotate: (degrees) => rotateSelection(Number(degrees)),
  undo: undoLast,
  redo: redoLast,
  all: selectAll,
  copy: copySelection,
  paste,
  duplicate: duplicateSelection,
};

/** Keep the view's middle when its size changes; a fitted view stays fitted. */
function resize(width, height) {
  if (width === 0 || height === 0) return; // hidden
  const { camera, size } = editor;
  editor.size = { width, height };
  if (editor.pressed) return; // what the hand holds stays under it
  if (editor.fitted) fitAll();
  else editor.camera = pan(camera, [(width - size.width) / 2, (height - size.height) / 2]);
}

/** Show all of a document that is new, or of which nothing would be seen. */
function fitNew(document) {
  const { past, future } = state.history;
  const fresh = past.length === 0 && future.length === 0 && !editor.dragging;
  const { joints } = document.grid;
  if (fresh || (joints.length && !editor.dragging && !anyVisible(editor.camera, editor.size, joints))) {
    clearMarks();
    editor.popover = null;
    fitAll();
  }
}

/** All that is drawn in mm; the camera changes two attributes and nothing inside. */
const World = {
  render() {
    const { x, y, scale } = editor.camera;
    return h("g", {
      class: ["plan-world", { far: scale < 1.7, farther: scale < 0.4 }],
      transform: `matrix(${scale} 0 0 ${-scale} ${x} ${y})`,
      style: { "--scale": sizeScale(scale) },
    }, [h(Under), h(Parts), h(Marks), h(Places), h(Over)]);
  },
};

const Empty = {
  render() {
    if (state.document.grid.joints.length || editor.line?.fixed) return null;
    return h("div", { class: "plan-empty" }, [
      h("strong", t("plan.emptyTitle")), h("span", t("plan.emptyHint")),
    ]);
  },
};

/** What the tool in use expects; while a line is drawn also a button that ends it, for fingers. */
const Hint = {
  render() {
    const { tool } = state;
    const name = tool === "draw" && !editor.line?.fixed ? "DrawStart" : tool[0].toUpperCase() + tool.slice(1);
    if (state.tool === "select" && state.selection.beams.length === 0) return null;
    return h("div", { class: "plan-hint" }, [
      h("span", t(`plan.hint${name}`)),
      editor.line?.fixed > 1
        ? h("button", { type: "button", onClick: () => currentTool().finish() }, t("plan.done"))
        : null,
    ]);
  },
};

/** The last edit in words, read by screen readers. */
const Message = {
  render: () => h("p", { class: "plan-message", role: "status", "aria-live": "polite" }, editor.message),
};

