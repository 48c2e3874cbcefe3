// Draws on a canvas in 2D with the processor, on all machines: without a graphics card a browser takes seconds for
// what it believes a card will draw, and the page does not answer meanwhile.
export const penOf = (canvas) => canvas.getContext("2d", { willReadFrequently: true });
