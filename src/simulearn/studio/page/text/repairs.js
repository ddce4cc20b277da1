// What `document/repairs.js` offers to do about a message.
export const repairs = {
  en: {
    setActuator: "Set the actuator to {percent} %",
    clearActuator: "Remove the actuator",
    merge: "Merge joints {a} and {b}",
    once: "Draw beams {a} and {b} once where they run together",
    joinBeams: "Add a joint where beams {a} and {b} cross",
    joinJoint: "Join beam {beam} to joint {joint}",
    fix: "Fix joint {joint}",
    removeBeam: "Remove beam {beam}",
    removeBeams: "Remove the {count} beams of the smaller parts",
    removeJoint: "Remove joint {joint}",
  },
  de: {
    setActuator: "Aktor auf {percent} % setzen",
    clearActuator: "Aktor entfernen",
    merge: "Knoten {a} und {b} verbinden",
    once: "Stäbe {a} und {b} nur einmal zeichnen, wo sie zusammenlaufen",
    joinBeams: "Knoten setzen, wo sich Stäbe {a} und {b} kreuzen",
    joinJoint: "Stab {beam} mit Knoten {joint} verbinden",
    fix: "Knoten {joint} festhalten",
    removeBeam: "Stab {beam} entfernen",
    removeBeams: "Die {count} Stäbe der kleineren Teile entfernen",
    removeJoint: "Knoten {joint} entfernen",
  },
};
