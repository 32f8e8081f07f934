// The page of a run: its progress, its stop, its results, and its report by one click.

const data = JSON.parse(document.getElementById("data").textContent);
const byId = (id) => document.getElementById(id);
const LATER = 400; // ms

async function state() {
  return (await fetch(`${data.root}run/${data.run}/state`)).json();
}

async function post(what) {
  return fetch(`${data.root}run/${data.run}/${what}`, {
    method: "POST", headers: { "Content-Type": "application/json" }, body: "{}",
  });
}

async function watch() {
  try {
    const now = await state();
    if (["done", "failed", "stopped"].includes(now.state)) {
      window.location.reload();
      return;
    }
    if (byId("state").textContent !== now.words) byId("state").textContent = now.words;
    if (now.percent === null) byId("progress").removeAttribute("value");
    else byId("progress").value = now.percent;
    byId("line").textContent = now.line;
  } catch (error) {
    // the next question may find the server again
  }
  setTimeout(watch, LATER);
}

async function made() {
  const { report, has_report: ready } = await state();
  if (ready) return "";
  if (report && ["failed", "stopped"].includes(report.state)) return report.message || report.state;
  await new Promise((done) => setTimeout(done, LATER));
  return made();
}

// The first click on PDF or XLSX makes both; each of them then downloads what its link names.
async function makeReport(event) {
  const link = event.currentTarget;
  if (!("make" in link.dataset)) return;
  event.preventDefault();
  if (link.getAttribute("aria-busy") === "true") return;
  link.setAttribute("aria-busy", "true");
  byId("making").textContent = data.words.making;
  const answer = await post("report");
  const failed = answer.ok ? await made() : await answer.text();
  link.removeAttribute("aria-busy");
  byId("making").textContent = failed ? data.words.failed.replace("{message}", failed) : "";
  if (failed) return;
  document.querySelectorAll("a[data-make]").forEach((one) => delete one.dataset.make);
  link.click();
}

if (data.run && data.state !== "done") {
  if (byId("stop")) {
    byId("stop").addEventListener("click", () => {
      byId("stop").disabled = true;
      post("stop");
    });
  }
  if (["waiting", "running", "stopping"].includes(data.state)) watch();
}
document.querySelectorAll("a[data-make]").forEach((link) => link.addEventListener("click", makeReport));
if (byId("which")) {
  byId("which").addEventListener("change", () => {
    document.querySelectorAll("iframe").forEach((one, i) => { one.hidden = i !== byId("which").selectedIndex; });
  });
}
