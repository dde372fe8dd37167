// What the server announces. Browsers open few connections to a server, so all tabs share one stream, which a shared worker holds. Browsers
// without such workers open a stream for each tab.

/** @typedef {"open" | "message" | "reviews" | "reload" | "error"} Heard */

/** The port to the worker, once there is one. @type {MessagePort | null} */
let port = null;

/**
 * Hears everything after a revision, until there is an error.
 *
 * @param {number} since
 * @param {(kind: Heard, text: string) => void} heard
 */
export function hear(since, heard) {
    const path = "/api/annotate/events";
    if (typeof SharedWorker === "undefined") return hearAlone(`${path}?since=${since}`, heard);
    if (!port) {
        const worker = new SharedWorker(new URL("events_worker.js", import.meta.url), "events");
        worker.addEventListener("error", () => hearAlone(`${path}?since=${since}`, heard));
        port = worker.port;
        port.start();
    }
    port.onmessage = ({ data: { kind, text } }) => heard(kind, text);
    port.postMessage({ path, since });
}

/** @param {string} path @param {(kind: Heard, text: string) => void} heard */
function hearAlone(path, heard) {
    const source = new EventSource(path);
    for (const kind of /** @type {const} */ (["open", "message", "reviews", "reload"])) source.addEventListener(kind, (/** @type {any} */ event) => heard(kind, event.data ?? ""));
    source.addEventListener("error", () => {
        source.close();
        heard("error", "");
    });
}
