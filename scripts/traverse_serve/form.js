// A form: sends a draft while it is filled in, shows messages beside the fields and the drawing, and starts the run.
// Before it: format.js, symbols.js, places.js and stage.js of the page of results.

const form = byId("form");
const files = { ...data.files };
const view = { stage: null, sent: 0, shown: 0, busy: false, waiting: false };

function values() {
  const found = {};
  for (const [name, value] of new FormData(form)) if (typeof value === "string" && name) found[name] = value;
  for (const one of form.querySelectorAll('input[type="checkbox"]')) if (!one.checked) found[one.name] = "";
  if (data.form === "scene") found.files = files;
  return found;
}

async function post(what) {
  const response = await fetch(`${data.root}${data.form}/${what}`, {
    method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify(values()),
  });
  if (response.headers.get("Content-Type") !== "application/json") return { errors: {}, general: await response.text() };
  return JSON.parse(await response.text(), decoded);
}

function showErrors(answer) {
  for (const field of form.querySelectorAll("[data-field]")) {
    const message = answer.errors[field.dataset.field] || "";
    const place = byId(`error-${field.dataset.field}`);
    if (place.textContent !== message) place.textContent = message;
    field.classList.toggle("wrong", message !== "");
    field.querySelectorAll("input, select, textarea").forEach((one) => one.setAttribute("aria-invalid", message !== ""));
    const folded = field.closest("details");
    if (message && folded) folded.open = true;
  }
  byId("general").textContent = answer.general;
}

function showStage(stage) {
  byId("side").classList.toggle("late", !stage);
  byId("described").open = !stage;
  if (!stage) return;
  if (view.stage) {
    view.stage.stage = stage;
    view.stage.resize();
  } else {
    view.stage = new Stage(byId("drawing"), stage);
  }
  byId("drawn").textContent = stage.words;
}

function showWords(answer) {
  byId("facts").textContent = "";
  answer.facts.forEach(([name, text], i) => {
    byId("facts").append(element("dt", "", name), element("dd", data.form === "check" && !i ? "needed" : "", text));
  });
  byId("unusual").textContent = "";
  if (answer.unusual.length) byId("unusual").append(element("strong", "", data.words.unusual));
  answer.unusual.forEach((line) => byId("unusual").append(element("p", "", line)));
  byId("cost").textContent = answer.cost;
  byId("described").hidden = !answer.described;
  byId("described").querySelector("pre").textContent = answer.described;
}

// One draft at a time; what is typed meanwhile is sent after it.
async function draft() {
  if (view.busy) {
    view.waiting = true;
    return;
  }
  view.busy = true;
  try {
    const answer = await post("draft");
    showErrors({ errors: {}, general: "", ...answer });
    if (answer.facts) {
      showStage(answer.stage);
      showWords(answer);
    }
    view.shown += 1;
  } catch (error) {
    byId("general").textContent = data.words.lost;
  }
  view.busy = false;
  if (view.waiting) {
    view.waiting = false;
    draft();
  }
}

function typed() {
  clearTimeout(view.timer);
  view.timer = setTimeout(draft, 250);
}

async function start(event) {
  event.preventDefault();
  byId("go").disabled = true;
  try {
    const answer = await post("run");
    if (answer.run) {
      window.location.href = `${data.root}run/${answer.run}`;
      return;
    }
    showErrors(answer);
    const wrong = form.querySelector(".wrong input, .wrong select, .wrong textarea");
    if (wrong) wrong.focus();
  } catch (error) {
    byId("general").textContent = data.words.lost;
  }
  byId("go").disabled = false;
}

// The files that are sent with a scene of one's own.
function listFiles() {
  byId("sent").textContent = "";
  for (const name of Object.keys(files)) {
    const row = element("li", "", name);
    const button = element("button", "", data.words.remove);
    button.type = "button";
    button.setAttribute("aria-label", `${data.words.remove}: ${name}`);
    button.addEventListener("click", () => {
      delete files[name];
      listFiles();
      typed();
    });
    row.append(button);
    byId("sent").append(row);
  }
}

async function addFiles(event) {
  for (const file of event.target.files) files[file.name] = await file.text();
  event.target.value = "";
  listFiles();
  typed();
}

async function showExample(event) {
  if (!event.target.value) return;
  const answer = await (await fetch(`${data.root}example/${event.target.value}`)).json();
  byId("text").value = answer.text;
  Object.keys(files).forEach((name) => delete files[name]);
  Object.assign(files, answer.files);
  listFiles();
  draft();
}

form.addEventListener("input", typed);
form.addEventListener("submit", start);
if (data.form === "scene") {
  byId("files").addEventListener("change", addFiles);
  byId("example").addEventListener("change", showExample);
  listFiles();
}
if (data.form !== "scene" || byId("text").value) draft();
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => view.stage && view.stage.draw(view.stage.time));
