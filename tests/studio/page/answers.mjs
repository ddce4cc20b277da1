// Answers questions of tests in Python: {name: [question, ...]} on stdin, {name: [answer, ...]} on stdout.

import { readFileSync } from "node:fs";
import { cornerAngles } from "../../../src/simulearn/studio/page/document/corners.js";
import { emptyDocument, readDocument } from "../../../src/simulearn/studio/page/document/document.js";
import { addPolyline } from "../../../src/simulearn/studio/page/document/drawing.js";
import * as edit from "../../../src/simulearn/studio/page/document/edit.js";
import { repair } from "../../../src/simulearn/studio/page/document/repairs.js";
import { taskOf } from "../../../src/simulearn/studio/page/document/task.js";
import { repairs as strings } from "../../../src/simulearn/studio/page/text/repairs.js";

const ANSWERS = {
  /** The grid of polylines drawn one after the other. */
  sketch: (lines) => lines.reduce((document, line) => addPolyline(document, line), emptyDocument()).grid,
  /** The grid after the first repair that one of the messages has, and its words; null if none has. */
  repair({ grid, messages, net, limits }) {
    const document = readDocument({ ...emptyDocument(), grid });
    for (const message of messages) {
      const found = repair(message, document, net, limits);
      if (found) return { code: message.code, grid: found.apply(document).grid, words: words(found) };
    }
    return null;
  },
  /** The directions of the corners of each joint. */
  corners: (grid) => grid.joints.map((_, k) => cornerAngles(grid, k)),
  /** The document after edits [name, ...values]. */
  edit: ({ document, edits }) =>
    edits.reduce((one, [name, ...values]) => edit[name](one, ...values), readDocument(document)),
  task: ({ document, options }) => taskOf(readDocument(document), options),
};

/** The words of a repair in both languages; an error where one is missing. */
function words({ label, values }) {
  return Object.values(strings).map((language) => {
    const text = language[label.replace("repairs.", "")];
    return text.replace(/\{(\w+)\}/g, (_, name) => {
      if (!(name in values)) throw new Error(`${label} has no value ${name}`);
      return values[name];
    });
  });
}

const questions = JSON.parse(readFileSync(0, "utf8"));
const answers = Object.entries(questions).map(([name, all]) => [name, all.map(ANSWERS[name])]);
process.stdout.write(JSON.stringify(Object.fromEntries(answers)));
