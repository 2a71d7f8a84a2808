# SPDX-License-Identifier: GPL-3.0-or-later
# python opencue_job.py [--print], in this folder: gives OpenCue what is left of its plan, a layer for each group of jobs, a frame for each
# job. Written by nook plan, the same for every plan. SHOW, SHOT and USER name the job. NOOK_PLAN: this folder as the farm sees it.
import getpass
import json
import os
import shlex
import sys

import outline
import outline.cuerun
from outline.modules.shell import Shell

HERE = os.path.dirname(os.path.abspath(__file__))
FOLDER = os.environ.get("NOOK_PLAN", HERE)


def layers(plan):
    """A layer for each group, by its name."""
    made = {}
    for group in plan["groups"]:
        layer = Shell(
            "nook." + group["name"],
            command=["sh", shlex.quote(FOLDER + "/job.sh"), "#IFRAME#"],
            chunk=1,
            range="%d-%d" % (group["first"], group["first"] + group["jobs"] - 1),
            threads=group["threads"],
            overrideCores=True,
            memory="%dm" % group["ask_memory_mib"],
        )
        for name in group["after"]:
            layer.depend_all(made[name])
        made[group["name"]] = layer
    return list(made.values())


def main():
    with open(os.path.join(HERE, "plan.json"), encoding="utf-8") as file:
        plan = json.load(file)
    last = max(group["first"] + group["jobs"] - 1 for group in plan["groups"])
    job = outline.Outline(
        "nook",
        frame_range="1-%d" % last,
        show=os.environ.get("SHOW", "testing"),
        shot=os.environ.get("SHOT", "shot01"),
        user=os.environ.get("USER", getpass.getuser()),
    )
    for layer in layers(plan):
        job.add_layer(layer)
    if "--print" in sys.argv[1:]:
        for layer in job.get_layers():
            print(layer.get_name(), layer.get_frame_range(), layer.get_arg("memory"))
        return
    outline.cuerun.launch(job, use_pycuerun=False)


main()
