// Starts the page: settings, the document of the address, then simulation and saving.

import { createApp } from "/libraries/vue.js";
import { App } from "./panels/app.js";
import { startKeys } from "./panels/keys.js";
import { startFiles } from "./service/files.js";
import { startMaterials } from "./service/materials.js";
import { startMeasuring } from "./service/measuring.js";
import { startResuming } from "./service/resuming.js";
import { openAddress, startSaving } from "./service/saving.js";
import { startServer } from "./service/server.js";
import { startSettings } from "./service/settings.js";
import { startSimulation } from "./service/simulation.js";

startSettings();
createApp(App).mount("#studio");
startKeys();
startFiles();
startSaving();
startSimulation();
startServer();
startMaterials();
startMeasuring();
startResuming();
openAddress();
