// Requests to the server. A refused one throws an ApiError that says what is wrong and what to do.

export class ApiError extends Error {
    /**
     * @param {number} status HTTP status; 0 when the server does not answer
     * @param {string} message
     * @param {string} help
     */
    constructor(status, message, help) {
        super(message);
        this.status = status;
        this.help = help;
    }
}

/**
 * @param {string} path
 * @param {RequestInit} [options]
 */
async function request(path, options) {
    let response;
    try {
        response = await fetch(path, options);
    } catch (error) {
        if (error instanceof DOMException && error.name === "AbortError") throw error;
        throw new ApiError(0, "The server does not answer.", "Start it again; nothing that you did is lost.");
    }
    if (response.ok) return response;
    const said = await response.json().catch(() => ({}));
    throw new ApiError(response.status, said.error ?? `The server answered ${response.status}.`, said.help ?? "");
}

/**
 * @param {string} path
 * @param {{ signal?: AbortSignal }} [options]
 * @returns {Promise<any>}
 */
export const getJson = async (path, options) => (await request(path, options)).json();

/**
 * @param {string} path
 * @param {{ signal?: AbortSignal, heard?: (share: number) => void }} [options] `heard` is told which share has come
 * @returns {Promise<ArrayBuffer>}
 */
export async function getBytes(path, { heard, ...options } = {}) {
    const response = await request(path, options);
    const bytes = Number(response.headers.get("x-enfilade-bytes"));
    if (!heard || !bytes || !response.body) return response.arrayBuffer();
    const whole = new Uint8Array(bytes);
    const reader = response.body.getReader();
    for (let at = 0; ; ) {
        const { done, value } = await reader.read();
        if (done) return whole.buffer;
        whole.set(value, at);
        at += value.length;
        heard(at / bytes);
    }
}

/**
 * @param {string} path
 * @param {unknown} body
 * @returns {Promise<any>}
 */
export const postJson = async (path, body) =>
    (await request(path, { method: "POST", headers: { "content-type": "application/json" }, body: JSON.stringify(body) })).json();
