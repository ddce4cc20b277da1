export const shape = {
  en: {},
  de: {},
};
