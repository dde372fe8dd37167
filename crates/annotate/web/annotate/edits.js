// Edits on their way to the server. One at a time and in order; what is not acknowledged is kept and sent again, over reloads too. Each has
// an id, by which the server knows one that had arrived although its answer was lost.

import { ApiError, getJson, postJson } from "../shared/api.js";
import { toast, toastError } from "../shared/toast.js";

const RETRY_MS = 1500;
const STORE = "enfilade.annotate.unsent";

/** An id that nothing else has. Beyond this machine, without https, browsers have no `randomUUID`. */
const newId = () => crypto.randomUUID?.() ?? Array.from(crypto.getRandomValues(new Uint32Array(4)), (part) => part.toString(36)).join("-");

/** Sends edits and hears of those of other tabs. Events: `state` when something about saving has changed, `change` with a CHANGE. */
export class Edits extends EventTarget {
    /** @param {string} scene tells apart what is kept for several scenes */
    constructor(scene) {
        super();
        this.client = newId();
        this.store = `${STORE}:${scene}`;
        /** @type {{ id: string, action: any, done: (change: any) => void }[]} */
        this.queue = [];
        this.offline = false;
        this.busy = false;
        for (const kept of JSON.parse(sessionStorage.getItem(this.store) ?? "[]")) this.queue.push({ ...kept, done: () => {} });
        if (this.queue.length > 0) toast(`${this.queue.length} edits were not acknowledged by the server; they are sent again.`, "", "good");
    }

    /** @returns {"saved" | "saving" | "offline"} */
    get state() {
        return this.offline ? "offline" : this.queue.length > 0 ? "saving" : "saved";
    }

    /**
     * Sends an edit. Resolves with the CHANGE, or null where it was refused, which the user has been told then.
     *
     * @param {any} action
     * @returns {Promise<any>}
     */
    send(action) {
        return new Promise((done) => {
            this.queue.push({ id: newId(), action, done });
            this.keep();
            void this.work();
        });
    }

    keep() {
        sessionStorage.setItem(this.store, JSON.stringify(this.queue.map(({ id, action }) => ({ id, action }))));
        this.dispatchEvent(new Event("state"));
    }

    async work() {
        if (this.busy) return;
        this.busy = true;
        while (this.queue.length > 0) {
            const { id, action, done } = this.queue[0];
            let change = null;
            try {
                change = await postJson("/api/annotate/edit", { client: this.client, id, action });
                this.offline = false;
            } catch (error) {
                if (error instanceof ApiError && error.status === 0) {
                    this.setOffline(true);
                    await new Promise((resume) => setTimeout(resume, RETRY_MS));
                    continue;
                }
                toastError(error);
            }
            this.queue.shift();
            if (change) this.dispatchEvent(new CustomEvent("change", { detail: change }));
            this.keep();
            done(change);
        }
        this.busy = false;
    }

    /** @param {boolean} offline */
    setOffline(offline) {
        if (this.offline === offline) return;
        this.offline = offline;
        this.dispatchEvent(new Event("state"));
    }

    /**
     * Hears of changes from here on. After a break the server replays what was missed, or asks for a reload.
     *
     * @param {() => number} revision the last one that is known
     * @param {() => void} reload takes everything anew
     */
    listen(revision, reload) {
        const source = new EventSource(`/api/annotate/events?since=${revision()}`);
        source.addEventListener("message", (event) => {
            this.dispatchEvent(new CustomEvent("change", { detail: JSON.parse(event.data) }));
        });
        source.addEventListener("reload", reload);
        source.addEventListener("open", () => this.setOffline(false));
        source.addEventListener("error", () => {
            this.setOffline(true);
            source.close();
            setTimeout(() => void this.resume(revision, reload), RETRY_MS);
        });
    }

    /** @param {() => number} revision @param {() => void} reload */
    async resume(revision, reload) {
        try {
            const scene = await getJson("/api/annotate/scene");
            if (scene.revision < revision()) reload();
        } catch {
            setTimeout(() => void this.resume(revision, reload), RETRY_MS);
            return;
        }
        this.listen(revision, reload);
    }
}
