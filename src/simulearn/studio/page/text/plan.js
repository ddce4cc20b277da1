export const plan = {
  en: {},
  de: {},
};
