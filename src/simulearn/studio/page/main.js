// Starts the page: the shapes of the library, the document, the simulation, then the views.

import { createApp } from "/libraries/vue.js";
import { App } from "./panels/app.js";
import { library } from "./service/api.js";
import { startSimulation } from "./service/simulation.js";
import { load, state } from "./store.js";
import { emptyDocument } from "./document/document.js";

const FIRST = "twist"; // the design that a first visitor sees

async function start() {
  const { designs } = await library();
  state.library = designs;
  const first = designs.find(({ name }) => name === FIRST);
  load({ ...emptyDocument(), name: first.name, grid: first.grid });
  startSimulation();
  createApp(App).mount("#studio");
}

start();
