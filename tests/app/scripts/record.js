// Record what the page shows, and when it says that it is not up to date.
() => {
  window.samples = [];
  window.longestPause = 0;
  let last = "", before = performance.now();
  const box = (name) => document.querySelector(`[data-name="${name}"] input[type=text]`);
  const look = (moment) => {
    window.longestPause = Math.max(window.longestPause, moment - before);
    before = moment;
    const number = document.querySelector("dd[data-name=max_pressure]"), app = document.querySelector(".app");
    const mark = app.dataset.lost ? "lost" : app.dataset.updating ? "updating" : number ? "" : "no number";
    const sample = [box("load")?.value, box("clearance")?.value, mark, number?.dataset.value];
    if (String(sample) !== last) window.samples.push([moment, ...sample]);
    last = String(sample);
    requestAnimationFrame(look);
  };
  requestAnimationFrame(look);
}
