// Numbers as the page writes and reads them.

import assert from "node:assert/strict";
import test from "node:test";
import {
  editableNumber, formatNumber, parseNumber,
} from "../../../src/simulearn/studio/page/text/numbers.js";

test("numbers have the decimal sign of the language and no zeros at the end", () => {
  assert.equal(formatNumber(35.25, "en", 1), "35.3");
  assert.equal(formatNumber(35.2, "de", 1), "35,2");
  assert.equal(formatNumber(60, "de", 1), "60");
  assert.equal(formatNumber(1234.5, "en", 1), "1234.5");
});

test("a number to be read has a minus sign, one in a field a hyphen", () => {
  assert.equal(formatNumber(-2.5, "en"), "−2.5");
  assert.equal(editableNumber(-2.5, "en"), "-2.5");
});

test("what is rounded to zero has no sign, what is no number a dash", () => {
  assert.equal(formatNumber(-0.04, "en", 1), "0");
  assert.equal(formatNumber(NaN, "en", 1), "–");
});

test("a point, a comma, a sign and a unit are read", () => {
  const texts = { "65": 65, "65.5": 65.5, " 65,5 mm": 65.5, "-3": -3, "−3": -3, "+3": 3, ".5": 0.5, "50 %": 50, "90°": 90 };
  for (const [text, value] of Object.entries(texts)) assert.equal(parseNumber(text), value, text);
});

test("what is no number is none", () => {
  for (const text of ["", "abc", "1e3", "1.2.3", "1,000.5", "--1", "5 cm", "NaN"]) {
    assert.equal(parseNumber(text), null, text);
  }
});

test("every number that is written is read as itself", () => {
  for (const language of ["en", "de"])
    for (const value of [0, 1, -1, 0.125, -65.375, 99999.5])
      for (const write of [editableNumber, formatNumber])
        assert.equal(parseNumber(write(value, language, 3)), value);
});
