# SPDX-License-Identifier: GPL-3.0-or-later
# openjd.py TEMPLATE...: checks job templates by what the Open Job Description specification 2023-09 says of the parts that nook writes
# ("Template Schemas", sections 1 to 3, 5 and 7). No package of Debian or npm does.
import json
import re
import sys
import unicodedata

IDENTIFIER = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")


def fail(what, found, expected):
    sys.exit("%s: found %r, expected %s" % (what, found, expected))


def keys(what, item, needed, allowed=()):
    if not isinstance(item, dict) or not set(needed) <= set(item) <= set(needed) | set(allowed):
        fail(what, item, "an object of %s, and perhaps %s" % (", ".join(needed), ", ".join(allowed)))


def text(what, value, most, lines=False):
    controls = [c for c in value if unicodedata.category(c) == "Cc" and not (lines and c in "\n\t")]
    if not isinstance(value, str) or not 1 <= len(value) <= most or controls:
        fail(what, value, "1 to %d characters that print" % most)


def listed(what, items, most=None):
    if not isinstance(items, list) or not items or (most is not None and len(items) > most):
        fail(what, items, "a list of 1 to %s" % (most or "any number"))
    return items


def format_string(what, value, known):
    for expression in re.findall(r"\{\{(.*?)\}\}", value):
        if expression.strip() not in known:
            fail(what, value, "references to " + ", ".join(sorted(known)))


def parameter(item):
    keys("parameterDefinitions", item, ["name", "type"], ["description", "default", "objectType", "dataFlow"])
    if not IDENTIFIER.fullmatch(item["name"]) or len(item["name"]) > 64 or item["type"] != "PATH":
        fail("parameterDefinitions", item, "an identifier of type PATH")
    text("description", item.get("description", "-"), 2048, True)
    if item.get("objectType", "FILE") not in ("FILE", "DIRECTORY") or item.get("dataFlow", "NONE") not in ("NONE", "IN", "OUT", "INOUT"):
        fail("parameterDefinitions", item, "known kinds of path")
    if len(item.get("default", "")) > 1024:
        fail("default", item["default"], "at most 1024 characters")
    return item["name"]


def task_parameters(space):
    keys("parameterSpace", space, ["taskParameterDefinitions"], ["combination"])
    names = []
    for item in listed("taskParameterDefinitions", space["taskParameterDefinitions"], 16):
        keys("taskParameterDefinitions", item, ["name", "type", "range"])
        ends = re.fullmatch(r"(\d+)-(\d+)", str(item["range"]))
        if item["type"] != "INT" or not IDENTIFIER.fullmatch(item["name"]) or not ends or int(ends[1]) > int(ends[2]):
            fail("taskParameterDefinitions", item, "an INT with a range A-B")
        names.append(item["name"])
    return names


def step(item, earlier, parameters):
    keys("steps", item, ["name", "script"], ["description", "dependencies", "hostRequirements", "parameterSpace", "stepEnvironments"])
    text("step name", item["name"], 64)
    if item["name"] in earlier:
        fail("steps", item["name"], "a name of its own")
    if "dependencies" in item:
        found = [one["dependsOn"] for one in listed("dependencies", item["dependencies"])]
        if len(set(found)) != len(found) or not set(found) <= set(earlier):
            fail("dependencies of " + item["name"], found, "steps before it, each once")
    amounts = listed("amounts", item["hostRequirements"]["amounts"], 50)
    for amount in amounts:
        keys("amounts", amount, ["name"], ["min", "max"])
        least = {"amount.worker.vcpu": 1, "amount.worker.memory": 0}.get(amount["name"])
        if least is None or isinstance(amount["min"], bool) or not isinstance(amount["min"], (int, float)) or amount["min"] < least:
            fail("amounts", amount, "processors or memory, and a number")
    known = {"Param." + name for name in parameters} | {"RawParam." + name for name in parameters} | {"Session.WorkingDirectory"}
    for name in task_parameters(item["parameterSpace"]):
        known |= {"Task.Param." + name, "Task.RawParam." + name}
    keys("script", item["script"], ["actions"], ["embeddedFiles"])
    keys("actions", item["script"]["actions"], ["onRun"])
    run = item["script"]["actions"]["onRun"]
    keys("onRun", run, ["command"], ["args", "timeout", "cancelation"])
    for word in [run["command"]] + listed("args", run["args"]):
        text("onRun", word, 1 << 15)
        format_string("onRun", word, known)
    if isinstance(run["timeout"], bool) or not isinstance(run["timeout"], int) or run["timeout"] < 1:
        fail("timeout", run["timeout"], "whole seconds")


def check(path):
    with open(path, encoding="utf-8") as file:
        job = json.load(file)
    keys(path, job, ["specificationVersion", "name", "steps"], ["description", "parameterDefinitions", "jobEnvironments"])
    if job["specificationVersion"] != "jobtemplate-2023-09":
        fail("specificationVersion", job["specificationVersion"], "jobtemplate-2023-09")
    text("name", job["name"], 128)
    text("description", job.get("description", "-"), 2048, True)
    parameters = [parameter(one) for one in listed("parameterDefinitions", job["parameterDefinitions"], 50)]
    earlier = []
    for one in listed("steps", job["steps"]):
        step(one, earlier, parameters)
        earlier.append(one["name"])


for name in sys.argv[1:]:
    check(name)
