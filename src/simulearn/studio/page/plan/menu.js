// The context menu of a part, or of an empty place.

import { Teleport, h, nextTick, onBeforeUnmount, onMounted, watch } from "/libraries/vue.js";
import { select, state } from "../store.js";
import { t } from "../text/text.js";
import {
  canPaste, copySelection, duplicateSelection, fitAll, fixJoint, flipBeams, mirrorSelection, paste,
  removeSelection, rotateSelection, selectAll, setBeams, splitMiddle, stepBeams,
} from "./actions.js";
import { editor, focusPart, onPage } from "./editor.js";
import { isSelected, only } from "./hit.js";
import { clamped } from "./placement.js";

const WIDTH = 236; // px
const ROW = 32; // px, of an entry, about
const RULE = 9; // px, of a line between groups

/** Open the menu of a part, or of an empty place where it is null, at a place of the screen. */
export function openMenu(screen, part) {
  if (part && !isSelected(state.selection, part)) select(only(part));
  if (part) editor.focus = part;
  editor.popover = null;
  editor.menu = { screen, part };
}

/** Return the groups of entries {label, key, run, disabled} of a part. */
function groups(part) {
  const entry = (label, key, run, disabled = false) => ({ label: t(`plan.${label}`), key, run, disabled });
  const some = state.selection.joints.length + state.selection.beams.length > 0;
  const own = [];
  if (part?.beam !== undefined)
    own.push(
      entry("longer", "+", () => stepBeams(1)), entry("shorter", "−", () => stepBeams(-1)),
      entry("flip", "B", () => flipBeams()), entry("remove", "0", () => setBeams(0)),
      entry("splitMiddle", "", () => splitMiddle(part.beam)),
    );
  if (part?.joint !== undefined)
    own.push(entry("fixHere", "", () => fixJoint(part.joint), state.document.grid.fixed === part.joint));
  return [
    own,
    [
      ...(part ? [entry("copy", "Ctrl C", copySelection)] : []),
      ...(part ? [entry("duplicate", "Ctrl D", duplicateSelection)] : []),
      entry("paste", "Ctrl V", paste, !canPaste()),
      ...(part ? [] : [entry("all", "Ctrl A", selectAll), entry("fit", "F", fitAll)]),
    ],
    [
      entry("mirrorX", "M", () => mirrorSelection("x")),
      entry("mirrorY", "Shift M", () => mirrorSelection("y")),
      entry("rotate", "R", () => rotateSelection(90)),
    ],
    part && some ? [entry("delete", "Del", removeSelection)] : [],
  ].filter((group) => group.length);
}

export const Menu = {
  setup() {
    let element = null;
    watch(() => editor.menu, async (menu) => {
      if (!menu) return;
      await nextTick();
      entries(element)[0]?.focus();
    });
    const close = () => {
      const { part } = editor.menu ?? {};
      editor.menu = null;
      focusPart(part ?? null);
    };
    const onKeydown = (event) => {
      const all = entries(element);
      const at = all.indexOf(document.activeElement);
      const last = all.length - 1;
      const step = { ArrowDown: at + 1, ArrowUp: at + last, Home: 0, End: last }[event.key];
      if (step !== undefined) all[step % all.length].focus();
      else if (event.key === "Escape" || event.key === "Tab") close();
      else return;
      event.preventDefault();
      event.stopPropagation();
    };
    const onPointerdown = ({ target }) => {
      if (editor.menu && !element?.contains(target)) editor.menu = null;
    };
    onMounted(() => document.addEventListener("pointerdown", onPointerdown, true));
    onBeforeUnmount(() => document.removeEventListener("pointerdown", onPointerdown, true));
    const onFocusout = ({ relatedTarget }) => {
      if (relatedTarget && !element?.contains(relatedTarget)) editor.menu = null;
    };
    return () => {
      const { menu } = editor;
      if (!menu) return null;
      const list = groups(menu.part);
      const height = list.reduce((sum, group) => sum + group.length * ROW + RULE, 0);
      const window = { width: innerWidth, height: innerHeight };
      const [x, y] = clamped(onPage(menu.screen), { width: WIDTH, height }, window);
      // Outside the plan, since a low one would cut it off.
      return h(Teleport, { to: "main" }, h("div", {
        class: "plan-menu", role: "menu", "aria-label": t("plan.menu"), onKeydown, onFocusout,
        ref: (el) => {
          element = el;
        },
        onContextmenu: (event) => event.preventDefault(),
        style: { transform: `translate(${x}px, ${y}px)`, width: `${WIDTH}px` },
      }, list.map((group, k) => h("div", { role: "group", key: k }, group.map((one) => {
        const { label, key, run, disabled } = one;
        return h("button", {
          type: "button", role: "menuitem", key: label, disabled, tabindex: -1,
          onClick: () => {
            close();
            run();
          },
        }, [h("span", label), h("kbd", { "aria-hidden": "true" }, key)]);
      })))));
    };
  },
};

function entries(element) {
  return [...(element?.querySelectorAll("[role=menuitem]:not(:disabled)") ?? [])];
}
