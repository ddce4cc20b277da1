// The document that the page edits: a grid, goals and what is to be printed on.

export const SCHEMA = "simulearn.document/1";

/** Return a document without joints. */
export function emptyDocument() {
  return {
    schema: SCHEMA,
    name: "",
    grid: {
      schema: "simulearn.grid/1",
      joints: [], beams: [], actuators: [], fixed: 0, material: "pla-hot-water",
    },
    goals: [], // [{ vertex: ["joint", k, "centre"], target: [x, y, z], weight: 1 }]
    printer: "ender-3",
  };
}
