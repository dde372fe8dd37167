// Saving what is shown as a picture.

import { el } from "../shared/dom.js";
import { toast } from "../shared/toast.js";

/**
 * Puts canvases over each other and gives the result to the browser's downloads.
 * @param {HTMLCanvasElement[]} canvases of one size, the lowest first; drawn in this moment
 * @param {string} name of the file, without its ending
 */
export function savePicture(canvases, name) {
    const [{ width, height }] = canvases;
    const whole = el("canvas", { width, height });
    const pen = whole.getContext("2d");
    for (const canvas of canvases) if (canvas.style.display !== "none" && canvas.width) pen.drawImage(canvas, 0, 0);
    whole.toBlob((/** @type {Blob | null} */ blob) => {
        if (!blob) return toast("The picture could not be saved.");
        const url = URL.createObjectURL(blob);
        el("a", { href: url, download: `${name}.png` }).click();
        setTimeout(() => URL.revokeObjectURL(url), 10_000);
        toast(`Saved ${name}.png.`, "", "good");
    }, "image/png");
}
