// A cycle that is played: one instant of it in all charts, in the numbers and on the bore.
(function () {
  const app = (window.ballsocket = window.ballsocket || {});
  const SVG = "http://www.w3.org/2000/svg";
  const WHOLE = 5000; // ms that a cycle takes here
  const digits = (value) => (value === null ? "–" : String(Number(value.toPrecision(4))));

  function marker(chart) {
    const line = document.createElementNS(SVG, "line"), spot = document.createElementNS(SVG, "circle");
    line.setAttribute("class", "cursor");
    spot.setAttribute("class", "spot");
    spot.setAttribute("r", 4.5);
    chart.append(line, spot);
    return { chart, line, spot, box: chart.dataset.box.split(" ").map(Number) };
  }
  function move({ chart, line, spot, box: [left, top, right, foot] }, phase, value) {
    const x = left + ((right - left) * phase) / chart.dataset.x;
    for (const [name, place] of [["x1", x], ["x2", x], ["y1", top], ["y2", foot]]) line.setAttribute(name, place);
    spot.setAttribute("cx", x);
    spot.setAttribute("cy", value === null ? -99 : foot - ((foot - top) * value) / chart.dataset.y);
  }
  function begin(player) {
    const data = JSON.parse(player.dataset.player), count = data.phase.length;
    const find = (selector) => player.querySelector(selector);
    const bar = find("input[type=range]"), play = find("button"), canvas = find("canvas.bowl"), output = find("output");
    const markers = [...player.querySelectorAll("svg[data-box]")].map(marker);
    let timer = null, instant = Math.min(count - 1, Number(document.getElementById(player.dataset.at).textContent) || 0);
    player.begun = true;
    function show() {
      bar.value = instant;
      markers.forEach((one, number) => move(one, data.phase[instant], data.courses[number].values[instant]));
      const words = data.courses.map((one) => `${one.name} ${digits(one.values[instant])} ${one.unit}`);
      output.textContent = `${data.phase[instant].toFixed(1)} % of the cycle: ${words.join(", ")}`;
      bar.setAttribute("aria-valuetext", output.textContent);
      app.frame(canvas, instant);
    }
    function halt() {
      window.clearInterval(timer);
      timer = null;
      play.textContent = "▶ Play";
      app.tell("edit", player.dataset.event, instant);
    }
    play.addEventListener("click", () => {
      if (timer) { halt(); return; }
      play.textContent = "❚❚ Pause";
      const start = performance.now(), first = instant;
      timer = window.setInterval(() => {
        if (!player.isConnected) { window.clearInterval(timer); return; }
        instant = (first + Math.floor(((performance.now() - start) / WHOLE) * count)) % count;
        show();
      }, 40);
    });
    bar.addEventListener("input", () => { if (timer) halt(); instant = Number(bar.value); show(); });
    bar.addEventListener("change", () => app.tell("edit", player.dataset.event, instant));
    show();
  }
  document.addEventListener("shown", () => {
    for (const player of document.querySelectorAll(".player")) if (!player.begun) begin(player);
  });
})();
