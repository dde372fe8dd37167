// A worker that fetches layers and unpacks them, so that the page never waits for either.

/** @typedef {{ id: number, url: string }} Order */
/** @type {Map<number, AbortController>} */
const running = new Map();

self.addEventListener("message", async (/** @type {MessageEvent<Order | { cancel: number }>} */ { data }) => {
    if ("cancel" in data) {
        running.get(data.cancel)?.abort();
        return;
    }
    const { id, url } = data;
    const abort = new AbortController();
    running.set(id, abort);
    const begin = performance.now();
    try {
        const response = await fetch(url, { signal: abort.signal });
        if (!response.ok) {
            const said = await response.json().catch(() => ({}));
            self.postMessage({ id, error: said.error ?? `the server answered ${response.status}`, help: said.help ?? "", status: response.status });
            return;
        }
        const head = (/** @type {string} */ name) => response.headers.get(`x-enfilade-${name}`) ?? "";
        const packed = await response.arrayBuffer();
        const dtype = head("dtype");
        const bytes = head("packing") === "planes" ? inOrder(packed, dtype === "float32" ? 4 : 2) : packed;
        const answer = {
            id,
            bytes,
            dtype,
            shape: head("shape").split(",").map(Number),
            size: head("size").split(",").map(Number),
            summary: JSON.parse(head("summary")),
            milliseconds: performance.now() - begin,
        };
        self.postMessage(answer, { transfer: [bytes] });
    } catch (error) {
        const gone = error instanceof DOMException && error.name === "AbortError";
        self.postMessage({ id, gone, error: "the server does not answer", help: "start it again", status: 0 });
    } finally {
        running.delete(id);
    }
});

/**
 * Elements from planes of bytes of one significance.
 * @param {ArrayBuffer} planes
 * @param {number} size bytes per element
 */
function inOrder(planes, size) {
    const from = new Uint8Array(planes);
    const count = from.length / size;
    if (size === 2) {
        const to = new Uint16Array(count);
        for (let i = 0; i < count; i++) to[i] = from[i] | (from[count + i] << 8);
        return to.buffer;
    }
    const to = new Uint32Array(count);
    for (let i = 0; i < count; i++) to[i] = from[i] | (from[count + i] << 8) | (from[2 * count + i] << 16) | (from[3 * count + i] << 24);
    return to.buffer;
}
