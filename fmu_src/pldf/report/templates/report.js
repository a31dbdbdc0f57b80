"use strict";
// Paper is smaller than the screen: draw the figures anew for it, and back.
const figures = () => document.querySelectorAll(".plotly-graph-div");
const resize = (figure, height, layout) => {
  figure.parentElement.style.height = `${height}px`;
  Plotly.relayout(figure, { ...layout, height });
};
addEventListener("beforeprint", () => {
  document.querySelectorAll("details").forEach((part) => { part.open = true; });
  figures().forEach((figure) => {
    const height = figure.layout.height;
    figure.dataset.height = height;
    resize(figure, Math.round(0.72 * height), { width: 680, autosize: false });
  });
});
addEventListener("afterprint", () => {
  figures().forEach((figure) => {
    const height = Number(figure.dataset.height);
    resize(figure, height, { width: null, autosize: true });
  });
});
