export const panels = {
  en: {},
  de: {},
};
