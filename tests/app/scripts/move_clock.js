// Let the clock of the page go on to a moment.
async (moment) => {
  window.moment = moment;
  await new Promise((resolve) => setTimeout(resolve, 250)); // more than two ticks of the page
  return document.body.dataset.lost === "yes";
}
