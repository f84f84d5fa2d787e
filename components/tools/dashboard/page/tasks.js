// Starts and ends the tasks of Tables I to XV of the paper.

const colours = ["green", "red", "blue", "yellow"];
const sides = ["left", "right"];
const needs = {
  follow_line: { line_colour: colours },
  search_object: { object_colour: colours },
  track_object: { object_colour: colours },
  pregrasp: { object_colour: colours, direction: ["", ...sides] },
  grasp: {},
  drop: { drop_zone_colour: colours },
  rotate: { direction: sides },
  explore: { direction: [...sides, "forwards", "backwards"] },
  follow_path: { path: null }, // a text
};

const element = (id) => document.getElementById(id);

function choice(parent, label, values) {
  const frame = document.createElement("label");
  const select = document.createElement("select");
  for (const value of values) {
    const option = document.createElement("option");
    option.value = value;
    option.textContent = value || "any";
    select.append(option);
  }
  frame.append(`${label.replaceAll("_", " ")} `, select);
  parent.append(frame);
  return select;
}

function text(parent, label, example) {
  const frame = document.createElement("label");
  const input = document.createElement("input");
  Object.assign(input, { type: "text", placeholder: example, size: 16 });
  frame.append(`${label} `, input);
  parent.append(frame);
  return input;
}

/** Builds the form. `call(service, request)` calls a service and shows its answer. */
export function buildTasks(call) {
  const kind = choice(element("task_form"), "task", Object.keys(needs));
  kind.id = "task_kind";
  const details = document.createElement("span");
  element("task_form").append(details);
  let fields = {};
  const rebuild = () => {
    details.replaceChildren();
    fields = {};
    for (const [name, values] of Object.entries(needs[kind.value]))
      fields[name] = values ? choice(details, name, values) : text(details, "path [m]", "0,0;1,0.5");
  };
  kind.addEventListener("change", rebuild);
  rebuild();
  element("task_start").addEventListener("click", () => {
    const words = [kind.value];
    for (const [name, field] of Object.entries(fields)) {
      const value = field.value.replaceAll(" ", "");
      if (value) words.push(`${name}=${value}`);
    }
    call("task", { task: words.join(" ") });
  });
  element("task_cancel").addEventListener("click", () => call("stand", {}));
}
