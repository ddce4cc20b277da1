// Unpacks the page's program and runs it. Where that is not possible, the still picture stays.

import { followTheme, language } from "./browser.js";
import { unpacked } from "./unpack.js";

const OLD = {
  en: "The moving shape needs a newer browser.",
  de: "Die bewegte Form braucht einen neueren Browser.",
};

const reason = document.querySelector("#reason");
reason.textContent = "";
followTheme();
unpacked("simulearn-program").then((packed) => packed.text()).then((program) => {
  const script = document.createElement("script");
  script.textContent = program;
  document.body.append(script);
}).catch(() => {
  reason.textContent = OLD[language()];
});
