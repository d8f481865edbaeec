"""Record of a page, frame by frame: inputs, headline, and the marks that qualify it."""

from dataclasses import dataclass

_START = """() => {
  window.samples = [];
  window.longestPause = 0;
  let last = "", before = performance.now();
  const box = (name) => document.querySelector(`[data-name="${name}"] input[type=text]`);
  const look = (moment) => {
    window.longestPause = Math.max(window.longestPause, moment - before);
    before = moment;
    const number = document.querySelector("dd[data-name=max_pressure]"), app = document.querySelector(".app");
    const sample = [box("load"), box("clearance")].map((element) => element && element.value);
    sample.push(number && number.dataset.value, app.dataset.lost || "", app.dataset.updating || "");
    if (String(sample) !== last) window.samples.push([moment, ...sample]);
    last = String(sample);
    requestAnimationFrame(look);
  };
  requestAnimationFrame(look);
}"""


@dataclass(frozen=True)
class Sample:
    """State of a page from a moment (ms) on."""

    moment: float
    load: str
    clearance: str
    pressure: str
    lost: str
    updating: str

    @property
    def marked(self):
        """True if there are no numbers, or the page says that they are not those of its inputs."""
        return self.pressure is None or bool(self.lost) or bool(self.updating)


def record(page):
    """Begin to record a page."""
    page.evaluate(_START)


def samples_of(page):
    """Samples so far, each with the ms that it lasted."""
    samples = [Sample(*sample) for sample in page.evaluate("window.samples")]
    end = page.evaluate("performance.now()")
    moments = [*(sample.moment for sample in samples[1:]), end]
    return [(sample, moment - sample.moment) for sample, moment in zip(samples, moments, strict=True)]


def longest_pause(page):
    """Longest time in ms without a frame, in which a busy machine cannot mark anything."""
    return page.evaluate("window.longestPause")


def longest_contradiction(samples, pressure_of):
    """Longest time in ms for which unmarked numbers were not those of the inputs."""
    longest = running = 0.0
    for sample, duration in samples:
        agrees = sample.marked or abs(float(sample.pressure) / pressure_of(sample.load, sample.clearance) - 1) < 1e-6
        running = 0.0 if agrees else running + duration
        longest = max(longest, running)
    return longest
