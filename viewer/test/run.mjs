// SPDX-License-Identifier: Apache-2.0
// Tests of the page in a headless Chromium without network (support.mjs has how): node run.mjs ["part of a name|another"]
import { end } from "./support.mjs";

for (const theme of ["player", "blank", "objects", "display", "camera", "first_sight", "plots", "compare", "files", "films", "large", "served"]) await import(`./${theme}.mjs`);
await end();
