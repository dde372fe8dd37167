// The page that shows a dataset: makes its parts and connects them.

import { byId } from "../shared/dom.js";
import { getDataset } from "./catalogue.js";
import { showMessage } from "./message.js";
import { Page } from "./page.js";
import { Session } from "./session.js";
import { Store } from "./state.js";

async function begin() {
    const store = new Store();
    const session = new Session(await getDataset(), store);
    const page = new Page(session, store);
    await session.follow();
    page.ready();
    // For tests and the console.
    Object.assign(window, { view: page });
}

begin().catch((error) => showMessage(byId("message"), error));
