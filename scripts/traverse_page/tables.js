// Tables: verdicts, effects, summary, options, notes. All cells are text.

const TAGS = ["kept", "broken", "not judged"];

// A value may be a pair of number and unit. Values with their unit are not broken into lines; `head` is beside the value
// on narrow screens.
function cell(value, head) {
  const words = Array.isArray(value) ? withUnit(...value) : typeof value === "number" ? digits(value) : value ?? "";
  const made = element("td", /^-?[\d.,]+(e-?\d+)?( \S{1,7}| kN m| N m)?$/.test(words) ? "number" : "", words);
  if (head) made.dataset.head = head;
  if (TAGS.includes(value)) {
    made.textContent = "";
    made.append(element("span", `tag ${value}`, said(value)));
  }
  return made;
}

function tableOf(head, rows) {
  const wide = element("div", "wide");
  wide.tabIndex = 0;
  wide.setAttribute("role", "region");
  wide.setAttribute("aria-label", said("result"));
  const table = element("table", head && head.length > 3 ? "many" : "");
  if (head) {
    const row = table.createTHead().insertRow();
    head.forEach((words) => {
      const made = element("th", "", words);
      made.scope = "col";
      row.append(made);
    });
  }
  const body = table.createTBody();
  rows.forEach((values) => body.insertRow().append(...values.map((value, i) => cell(value, head && head[i]))));
  wide.append(table);
  return wide;
}

// A closed part with a table, and a field that shows the rows with a text only if there are many.
function closedTable({ title, head, rows }) {
  const part = element("details");
  part.append(element("summary", "", `${title} (${rows.length})`));
  const table = tableOf(head, rows);
  if (rows.length > 15) {
    const field = element("input");
    field.type = "search";
    field.placeholder = said("find");
    field.setAttribute("aria-label", `${said("find")}: ${title}`);
    field.addEventListener("input", () => {
      const wanted = field.value.toLowerCase();
      table.querySelectorAll("tbody tr").forEach((row) => {
        row.hidden = !row.textContent.toLowerCase().includes(wanted);
      });
    });
    part.append(field);
  }
  part.append(table);
  return part;
}

function openTable({ title, head, rows, note }) {
  const part = element("div", "table");
  part.append(element("h2", "", title));
  if (note) part.append(element("p", "note", note));
  part.append(tableOf(head, rows));
  return part;
}

function showTables() {
  const place = byId("tables");
  const open = data.tables.filter((one) => !one.closed);
  open.forEach((one) => (one.first ? byId("verdicts") : place).append(openTable(one)));
  if (data.notes.length) {
    const part = element("details");
    part.append(element("summary", "", `${said("notes")} (${data.notes.length})`));
    const list = element("ol");
    data.notes.forEach((note) => list.append(element("li", "", note)));
    part.append(list);
    place.append(part);
  }
  data.tables.filter((one) => one.closed).forEach((one) => place.append(closedTable(one)));
}
