// Fields for numbers: typed exactly, taken over with Enter or on leaving, stepped with the arrows.

import { h, ref, useId } from "/libraries/vue.js";
import { view } from "../store.js";
import { editableNumber, formatNumber, parseNumber } from "../text/numbers.js";
import { t } from "../text/text.js";

const DIGITS = 3; // thousandths of a mm: finer than any print
const TENFOLD = 10; // times the step with the shift key

/** A number with its unit.
 *
 * value: a number, or null where several differ. commit(value, merge): takes a number over; `merge`
 * is a key for edits in a row where the arrow keys step, else null. none: what no number means, where the
 * field may be empty; the value is null then.
 */
export const NumberField = {
  props: {
    label: String, name: String, value: Number, unit: String, commit: Function, merge: String, none: String,
    least: { type: Number, default: -1e5 }, most: { type: Number, default: 1e5 },
    step: { type: Number, default: 1 }, digits: { type: Number, default: DIGITS },
  },
  setup(props) {
    const id = useId();
    const text = ref(null); // while it is edited
    const error = ref("");
    const shown = () => (
      props.value === null ? "" : editableNumber(props.value, view.language, props.digits)
    );
    const wrong = (value) => {
      if (value === null && props.none && !text.value?.trim()) return "";
      if (value === null) return t("common.notNumber");
      const outside = value < props.least || value > props.most;
      const [least, most] = [props.least, props.most].map((limit) => formatNumber(limit, view.language));
      return outside ? t("common.outside", { least, most }) : "";
    };
    const take = (value, merge = null) => {
      error.value = wrong(value);
      if (error.value) return false;
      text.value = null;
      props.commit(value, merge);
      return true;
    };
    const finish = () => {
      if (text.value === null || text.value === shown()) return revert();
      return take(parseNumber(text.value));
    };
    const revert = () => {
      text.value = null;
      error.value = "";
      return true;
    };
    const onKeydown = (event) => {
      const direction = { ArrowUp: 1, ArrowDown: -1 }[event.key];
      if (direction) {
        event.preventDefault();
        const from = parseNumber(text.value ?? shown()) ?? props.value ?? 0;
        const next = from + direction * props.step * (event.shiftKey ? TENFOLD : 1);
        take(Math.min(props.most, Math.max(props.least, next)), props.merge ?? null);
      } else if (event.key === "Enter") {
        event.preventDefault();
        if (finish()) event.target.select();
      } else if (event.key === "Escape" && (text.value !== null || error.value)) {
        event.stopPropagation();
        revert();
      }
    };
    return () => h("div", { class: "field" }, [
      h("label", { for: id }, props.label),
      h("div", { class: ["field-box", { wrong: error.value }] }, [
        h("input", {
          id, type: "text", inputmode: "decimal", autocomplete: "off", spellcheck: false,
          value: text.value ?? shown(), placeholder: props.value === null ? props.none ?? t("common.various") : undefined,
          "aria-label": props.name, "aria-invalid": error.value ? "true" : undefined,
          "aria-describedby": error.value ? `${id}-error` : undefined,
          onFocus: (event) => event.target.select(),
          onInput: (event) => {
            text.value = event.target.value;
            error.value = "";
          },
          onBlur: finish, onKeydown,
        }),
        props.unit && h("span", { class: "unit", "aria-hidden": "true" }, props.unit),
      ]),
      error.value && h("p", { class: "field-error", id: `${id}-error`, role: "alert" }, error.value),
    ]);
  },
};

/** Return a list of facts: [[name, value], ...]. */
export function facts(rows) {
  return h("dl", { class: "facts" }, rows.filter(Boolean).map(([name, value]) =>
    h("div", { key: name }, [h("dt", name), h("dd", value)])));
}
