// Starts and ends the tasks of Tables I to XV of the paper.

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

/** Builds the form from the tasks of the dashboard: [{task, parameters: [{name, values, optional}]}], no values: points.
 *  `call(service, request)` calls a service and shows its answer. */
export function buildTasks(tasks, call) {
  const kind = choice(element("task_form"), "task", tasks.map((each) => each.task));
  kind.id = "task_kind";
  const details = document.createElement("span");
  element("task_form").append(details);
  let fields = {};
  const rebuild = () => {
    details.replaceChildren();
    fields = {};
    for (const { name, values, optional } of tasks.find((each) => each.task === kind.value)?.parameters ?? []) {
      if (values.length === 0) fields[name] = text(details, `${name} [m]`, "0,0;1,0.5");
      else fields[name] = choice(details, name, optional ? ["", ...values] : values);
    }
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
