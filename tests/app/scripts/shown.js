// What the page shows of the joint: boxes, bars, handles, the answer and the link.
(names) => {
  const inputs = (kind, value) => Object.fromEntries(names.map((name) =>
    [name, value(document.querySelector(`[data-name="${name}"] input[type=${kind}]`).value)]));
  const handles = [...document.querySelectorAll("#press-section:not([data-expected]) [role=slider]")];
  const refused = names.filter((name) =>
    document.querySelector(`[data-name="${name}"] input[type=text]`).getAttribute("aria-invalid") === "true");
  const numbers = document.querySelector("#press-numbers");
  const answer = numbers.querySelector("dd[data-name=max_pressure]");
  const sentence = document.querySelector("#press-trouble .refused, #press-numbers:not([data-expected]) .refused");
  const works = document.querySelector("[data-name='press.run'] progress:not([hidden])");
  return {
    real: numbers.textContent.includes("in the real cup"),
    boxes: inputs("text", String),
    refused,
    bars: inputs("range", Number),
    handles: handles.map((handle) => [handle.dataset.drag, Number(handle.getAttribute("aria-valuenow"))]),
    answer: answer && !("expected" in numbers.dataset) ? answer.dataset.value : null,
    sentence: sentence && sentence.textContent,
    waits: "expected" in numbers.dataset || Boolean(works) || numbers.textContent.includes("Preparing"),
    link: window.location.search.slice(1),
  };
}
