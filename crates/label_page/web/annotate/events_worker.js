// A shared worker that holds one stream of announcements for all tabs. A tab that comes later is told what it has missed.

/** Announcements that are kept for tabs that come later. */
const KEPT = 300;

/** @type {Set<MessagePort>} */
const ports = new Set();
/** The stream; null where there is none. @type {EventSource | null} */
let source = null;
/** What is kept follows this revision. */
let from = 0;
/** @type {{ revision: number, text: string }[]} */
let kept = [];

/** @param {string} kind @param {string} [text] */
function tell(kind, text = "") {
    for (const port of ports) port.postMessage({ kind, text });
}

/** @param {MessagePort} port @param {string} path @param {number} since */
function join(port, path, since) {
    ports.add(port);
    if (!source) return begin(path, since);
    if (since < from) return port.postMessage({ kind: "reload", text: "" });
    for (const { revision, text } of kept) if (revision > since) port.postMessage({ kind: "message", text });
    if (source.readyState === EventSource.OPEN) port.postMessage({ kind: "open", text: "" });
}

/** @param {string} path @param {number} since */
function begin(path, since) {
    const stream = new EventSource(`${path}?since=${since}`);
    source = stream;
    [from, kept] = [since, []];
    stream.addEventListener("open", () => tell("open"));
    stream.addEventListener("message", ({ data, lastEventId }) => {
        kept.push({ revision: Number(lastEventId), text: data });
        if (kept.length > KEPT) from = kept.shift()?.revision ?? from;
        tell("message", data);
    });
    stream.addEventListener("reviews", () => tell("reviews"));
    stream.addEventListener("reload", () => end("reload"));
    stream.addEventListener("error", () => end("error"));
}

/** Ends the stream; the tabs begin another. @param {string} kind */
function end(kind) {
    source?.close();
    source = null;
    tell(kind);
}

self.addEventListener("connect", (/** @type {any} */ event) => {
    /** @type {MessagePort} */
    const port = event.ports[0];
    port.onmessage = ({ data: { path, since } }) => join(port, path, since);
});
