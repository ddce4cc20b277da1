// Starts the page: the shapes of the library, the document, the simulation, then the views.

import { createApp } from "/libraries/vue.js";
import { emptyDocument } from "./document/document.js";
import { App } from "./panels/app.js";
import { library } from "./service/api.js";
import { startSettings } from "./service/settings.js";
import { startSimulation } from "./service/simulation.js";
import { load, state } from "./store.js";

const FIRST = "twist"; // the design that a first visitor sees

async function start() {
  startSettings();
  createApp(App).mount("#studio");
  const { designs } = await library();
  state.library = designs;
  const first = designs.find(({ name }) => name === FIRST);
  load({ ...emptyDocument(), name: first.name, grid: first.grid });
  state.started = true;
  startSimulation();
}

start();
