export const common = {
  en: {
    studio: "SimuLearn studio",
    undo: "Undo {what}",
    redo: "Redo {what}",
  },
  de: {
    studio: "SimuLearn-Studio",
    undo: "Rückgängig: {what}",
    redo: "Wiederholen: {what}",
  },
};
