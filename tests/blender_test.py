# SPDX-License-Identifier: GPL-3.0-or-later
# blender -b --factory-startup --python-exit-code 1 --python blender_test.py -- PROGRAM SOURCE FOLDER: the add-on without a window.
# Without -b: its modal operator, Cancel and undo in a window. blender_test.sh runs both.
import csv, json, math, os, shutil, stat, struct, subprocess, sys, time, traceback

import bpy
import numpy as np

PROGRAM, SOURCE, FOLDER = (os.path.abspath(word) for word in sys.argv[sys.argv.index("--") + 1:])


def install():
    """Installs the add-on as a user does: copies it to the folder that BLENDER_USER_SCRIPTS names, and enables it."""
    bpy.ops.preferences.addon_install(filepath=os.path.join(SOURCE, "integrations/blender/nook_bake.py"))
    bpy.ops.preferences.addon_enable(module="nook_bake")
    bpy.context.preferences.addons["nook_bake"].preferences.program = PROGRAM
    return sys.modules["nook_bake"]


def scene():
    """Makes a cube on a plane, a monkey, turned and mirrored, and a ball at two places with one mesh."""
    for kind in (bpy.data.objects, bpy.data.meshes, bpy.data.collections):
        bpy.data.batch_remove(list(kind))
    bpy.ops.mesh.primitive_plane_add(size=8)
    bpy.ops.mesh.primitive_cube_add(size=1, location=(0, 0, 0.5))
    bpy.ops.mesh.primitive_monkey_add(location=(2.6, 0, 0.9), rotation=(0.3, 0.2, 0.1), scale=(-1, 1, 0.8))
    bpy.ops.object.shade_smooth()
    bpy.ops.mesh.primitive_uv_sphere_add(radius=0.5, segments=12, ring_count=8, location=(-2, 0, 0.4))
    ball = bpy.context.object
    other = ball.copy()
    other.name, other.location = "Open", (-2, 0, 3)
    bpy.context.collection.objects.link(other)
    bpy.context.view_layer.update()


def choose(*names):
    bpy.ops.object.select_all(action="DESELECT")
    for name in names:
        bpy.data.objects[name].select_set(True)
    bpy.context.view_layer.objects.active = bpy.data.objects[names[0]] if names else None


def settings(**values):
    given = {"radius": 1.0, "rays": 64, "occluders": "VISIBLE", "target": "FLOAT", "name": "Visibility", **values}
    for name, value in given.items():
        setattr(bpy.context.scene.nook_bake, name, value)


def values(name, attribute="_VISIBILITY", channel=None):
    found = bpy.data.objects[name].data.attributes[attribute]
    if channel is None:
        result = np.empty(len(found.data), np.float32)
        found.data.foreach_get("value", result)
        return result
    result = np.empty((len(found.data), 4), np.float32)
    found.data.foreach_get("color", result.reshape(-1))
    return result[:, channel]


def check(condition, text):
    check.count += 1
    if not condition:
        raise AssertionError(text)


check.count = 0


def refused(expected, call=lambda: bpy.ops.nook.bake()):
    try:
        call()
    except RuntimeError as error:
        check(expected in str(error), f"found '{error}', expected '{expected}'")
        check(len(str(error).strip().splitlines()) == 1, f"found '{error}', expected one line")
        return
    check(False, f"found no error, expected '{expected}'")


class Watched:
    """Keeps the notes of the last job, and a copy of its level, which the add-on removes."""

    def __init__(self, module):
        self.module, self.notes = module, []
        finish = module.Job.finish

        def watched(job):
            shutil.copy(job.path("scene.glb"), os.path.join(FOLDER, "level.glb"))
            self.folder = job.folder
            said = finish(job)
            self.notes = job.notes
            return said

        module.Job.finish = watched

    def bake(self, *names, **given):
        settings(**given)
        choose(*names)
        check(bpy.ops.nook.bake() == {"FINISHED"}, "found a bake that did not finish")
        check(not os.path.exists(self.folder), f"found {self.folder}, expected it to be removed")


def direct(file, *options, radius=1.0, rays=64):
    """Returns the program's values for a file, in the file's order."""
    out = os.path.join(FOLDER, "direct.csv")
    subprocess.run([PROGRAM, "bake", file, "--radius", str(radius), "--rays", str(rays), *options, "-o", out], check=True,
                   stdout=subprocess.DEVNULL)
    with open(out) as rows:
        return np.array([row["visibility"] for row in csv.DictReader(rows)], np.float32)


def exported(file):
    """Reads _VISIBILITY of a binary glTF file in the order of nodes and primitives; Blender 3.4 adds a second _ to the name."""
    with open(file, "rb") as data:
        data = data.read()
    size = struct.unpack("<I", data[12:16])[0]
    document, binary = json.loads(data[20:20 + size]), data[28 + size:]
    result = []
    for node in document["nodes"]:
        for primitive in document["meshes"][node["mesh"]]["primitives"] if "mesh" in node else []:
            attributes = primitive["attributes"]
            accessor = document["accessors"][attributes["__VISIBILITY" if "__VISIBILITY" in attributes else "_VISIBILITY"]]
            view = document["bufferViews"][accessor["bufferView"]]
            at = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
            result.append(np.frombuffer(binary, np.float32, accessor["count"], at))
    return np.concatenate(result)


def test_values(watched):
    names = ["Cube", "Plane", "Suzanne"]
    watched.bake(*names)
    check(watched.notes == [], f"found {watched.notes}, expected no notes")
    expected = direct(os.path.join(FOLDER, "level.glb"), "--receivers", "extras:receives")
    found = np.concatenate([values(name) for name in sorted(names)])
    check(np.array_equal(found, expected[:len(found)]), "found other values than those of the program for the same file")
    cube = bpy.data.objects["Cube"].data
    top = [corner for face in cube.polygons if face.normal.z > 0.9 for corner in face.loop_indices]
    check((values("Cube")[top] > 0.97).all(), f"found {values('Cube')[top]} on top of the cube, expected 1")
    low = [corner for face in cube.polygons if abs(face.normal.z) < 0.1 for corner in face.loop_indices
           if cube.vertices[cube.loops[corner].vertex_index].co.z < 0]
    check((values("Cube")[low] < 0.7).all(), f"found {values('Cube')[low]} at the foot of the cube, expected about half")


def test_exported(watched):
    """Bakes the file of Blender's own exporter, which places the same meshes: the values differ by noise only."""
    file = os.path.join(FOLDER, "exported.glb")
    watched.bake("Cube", "Plane", "Suzanne", rays=1024, occluders="SELECTED")
    bpy.ops.export_scene.gltf(filepath=file, use_selection=True, export_attributes=True)
    error = math.sqrt(np.square(exported(file) - direct(file, rays=1024)).mean())
    check(error < 0.03, f"found a difference of {error} to the file of Blender's exporter, expected noise")
    print(f"difference to the file of Blender's exporter: {error:.4f}")


def test_targets(watched):
    watched.bake("Cube", "Plane")
    expected = values("Cube")
    watched.bake("Cube", "Plane", target="COLOR")
    for channel in range(3):
        found = values("Cube", "Visibility", channel)
        check(np.array_equal(found, expected), "found other greys than the float attribute's values")
    check((values("Cube", "Visibility", 3) == 1).all(), "found an alpha, expected 1")
    cube = bpy.data.objects["Cube"].data
    paint = cube.color_attributes.new("Paint", "FLOAT_COLOR", "POINT")
    for item in paint.data:
        item.color = (0.25, 0.5, 0.75, 1)
    cube.color_attributes.active_color = paint
    watched.bake("Cube", "Plane", target="ALPHA")
    check(np.array_equal(values("Cube", "Paint", 1), np.full(8, 0.5, np.float32)), "found other colours, expected them kept")
    check(values("Cube", "Paint", 3).min() < 0.9, "found an alpha of 1, expected visibility")
    alphas = direct(os.path.join(FOLDER, "level.glb"), "--receivers", "extras:receives")
    check(np.array_equal(values("Cube", "Paint", 3), alphas[:8]), "found other alphas than the program's values")
    cube.color_attributes.remove(cube.color_attributes["Paint"])
    cube.attributes.remove(cube.attributes["_VISIBILITY"])
    cube.attributes.new("_VISIBILITY", "INT", "FACE")
    settings()
    choose("Cube")
    refused("_VISIBILITY: found INT per FACE, expected FLOAT per POINT or CORNER")
    cube.attributes.remove(cube.attributes["_VISIBILITY"])
    settings(target="COLOR", name=" ")
    refused("Attribute: found no name, expected one")


def test_occluders(watched):
    watched.bake("Plane", occluders="SELECTED")
    check(values("Plane").min() == 1, f"found {values('Plane')}, expected 1 without occluders")
    bpy.ops.object.select_all(action="DESELECT")
    group = bpy.data.collections.new("Roof")
    roof = bpy.data.objects["Plane"].copy()
    group.objects.link(roof)
    roof.location = (0, 0, 0)
    instance = bpy.data.objects.new("Instance", None)
    instance.instance_type, instance.instance_collection, instance.location = "COLLECTION", group, (0, 0, 0.2)
    bpy.context.collection.objects.link(instance)
    bpy.context.view_layer.update()
    watched.bake("Plane")
    check(values("Plane").mean() < 0.5, f"found {values('Plane')}, expected dark below an instance of a collection")
    instance.hide_set(True)
    watched.bake("Plane")
    check(values("Plane").mean() > 0.8, f"found {values('Plane')}, expected light below a hidden instance")
    bpy.data.objects.remove(instance)
    bpy.data.objects.remove(roof)


def test_shared_meshes(watched):
    watched.bake("Sphere", "Open", "Plane")
    expected = "Sphere: has 2 users, which all get the mean of the 2 selected"
    check(len(watched.notes) == 1 and expected in watched.notes[0], f"found {watched.notes}, expected {expected}")
    both = values("Sphere")
    rows = direct(os.path.join(FOLDER, "level.glb"), "--receivers", "extras:receives")
    count, plane = len(both), len(values("Plane"))
    mean = ((rows[:count].astype(np.float64) + rows[count + plane:][:count]) / 2).astype(np.float32)
    check(np.array_equal(both, mean), "found other values than the mean of both places")
    check(both.min() < 0.9, "found no darkening below the ball")


def test_modifiers(watched):
    cube = bpy.data.objects["Cube"]
    cube.modifiers.new("Wave", "CAST").factor = 0.2 # keeps vertices and faces
    watched.bake("Cube")
    check(watched.notes == [], f"found {watched.notes}, expected no notes")
    cube.modifiers.new("Bevel", "BEVEL")
    watched.bake("Cube")
    check(len(watched.notes) == 1 and "Cube: modifiers change its faces" in watched.notes[0], f"found {watched.notes}")
    check(len(values("Cube")) == 24, "found other values than one per corner of the mesh without modifiers")
    cube.modifiers.clear()


def test_refusals(watched):
    preferences = bpy.context.preferences.addons["nook_bake"].preferences
    settings()
    choose()
    refused("Found no selected object, expected meshes with faces")
    bpy.context.collection.objects.link(bpy.data.objects.new("Nothing", bpy.data.meshes.new("Nothing")))
    choose("Nothing")
    refused("Nothing: has no faces, so it gets no values")
    choose("Cube")
    vertex = bpy.data.objects["Cube"].data.vertices[0]
    place, vertex.co.x = vertex.co.x, math.nan
    refused("Cube: found a vertex that is not finite, expected numbers")
    vertex.co.x = place
    settings(radius=0)
    refused("--radius: found '0'")
    settings()
    for program, expected in (("/nowhere/nook", "nook: found no such program, expected its path"),
                              (shutil.which("true"), "wrote no values, expected the program nook"),
                              (shutil.which("false"), "nook: ended with 1, expected 0")):
        preferences.program = program
        refused(expected)
    broken = os.path.join(FOLDER, "broken")
    with open(broken, "w") as file:
        file.write("no program")
    os.chmod(broken, stat.S_IRWXU)
    preferences.program = broken
    refused("broken: Exec format error")
    preferences.program = ""
    path, os.environ["PATH"] = os.environ["PATH"], os.path.dirname(PROGRAM)
    watched.bake("Cube")
    os.environ["PATH"] = FOLDER
    refused("nook: found no such program")
    os.environ["PATH"] = path
    preferences.program = PROGRAM
    bpy.data.objects["Cube"].data.attributes.remove(bpy.data.objects["Cube"].data.attributes["_VISIBILITY"])
    choose("Cube")
    bpy.ops.object.mode_set(mode="EDIT")
    check(not bpy.ops.nook.bake.poll(), "found Bake in edit mode")
    bpy.ops.object.mode_set(mode="OBJECT")
    check("_VISIBILITY" not in bpy.data.objects["Cube"].data.attributes, "found values after refusals")


def test_cancelled(watched):
    settings(rays=16384)
    choose("Suzanne", "Plane", "Sphere")
    before = len(os.listdir(bpy.app.tempdir))
    job = watched.module.running_job = watched.module.Job(bpy.context, bpy.context.scene.nook_bake)
    while job.running() and not job.stage:
        time.sleep(0.01)
    check(job.process.poll() is None, "found a bake that ended before it was cancelled")
    check(not bpy.ops.nook.bake.poll(), "found a second bake beside the first")
    bpy.ops.nook.cancel()
    check(job.process.poll() is not None, "found the program still running")
    check(len(os.listdir(bpy.app.tempdir)) == before, "found files left behind")
    check(not bpy.ops.nook.cancel.poll(), "found Cancel without a bake")


def test_changed_meanwhile(watched):
    settings()
    choose("Suzanne", "Cube")
    job = watched.module.Job(bpy.context, bpy.context.scene.nook_bake)
    mesh = bpy.data.objects["Cube"].data
    bpy.data.objects["Cube"].data = bpy.data.meshes.new("Other")
    bpy.data.meshes.remove(mesh)
    job.process.wait()
    job.finish()
    check(job.notes == ["Cube: changed during the bake, so it gets no values"], f"found {job.notes}")


def without_window():
    watched = Watched(install())
    for name, test in list(globals().items()):
        if name.startswith("test_"):
            scene()
            test(watched)
            print(f"{name}: ok", flush=True)
    bpy.ops.preferences.addon_disable(module="nook_bake")
    check(not hasattr(bpy.types.Scene, "nook_bake"), "found settings of an add-on that is off")


def window_steps(module):
    """Bakes while Blender stays usable, undoes it, and cancels another bake. Each yield returns to Blender's main loop."""
    scene()
    bpy.ops.ed.undo_push(message="scene")
    settings(rays=16384)
    choose("Suzanne", "Plane", "Cube")
    check(bpy.ops.nook.bake("INVOKE_DEFAULT") == {"RUNNING_MODAL"}, "found no modal operator")
    seen = set()
    while module.running_job is not None:
        seen.add(module.running_job.stage)
        yield
    yield
    check(len(seen) > 1, f"found the stages {seen} while it ran, expected some")
    check(values("Suzanne").min() < 0.9, "found no values after the modal bake")
    bpy.ops.ed.undo()
    yield
    check("_VISIBILITY" not in bpy.data.objects["Suzanne"].data.attributes, "found values after undo")
    bpy.ops.ed.redo()
    yield
    check("_VISIBILITY" in bpy.data.objects["Suzanne"].data.attributes, "found no values after redo")
    bpy.ops.ed.undo()
    yield
    settings(rays=16384)
    choose("Suzanne", "Plane", "Sphere", "Cube")
    bpy.ops.nook.bake("INVOKE_DEFAULT")
    job = module.running_job
    while not job.stage:
        yield
    bpy.ops.nook.cancel()
    yield
    check(job.process.poll() is not None and not os.path.exists(job.folder), "found the program or its files after Cancel")
    check("_VISIBILITY" not in bpy.data.objects["Suzanne"].data.attributes, "found values after Cancel")
    bpy.data.objects["Suzanne"].location.x += 1
    bpy.ops.ed.undo_push(message="moved")
    bpy.ops.nook.bake("INVOKE_DEFAULT")
    bpy.ops.ed.undo() # before the bake can end
    while module.running_job is not None:
        yield
    yield
    check(values("Suzanne").min() < 0.9, "found no values of a bake during which the user undid a step")
    settings(rays=16384)
    choose("Suzanne", "Plane", "Sphere", "Cube")
    bpy.ops.nook.bake("INVOKE_DEFAULT")
    job = module.running_job
    while not job.stage:
        yield
    bpy.ops.wm.read_homefile(use_factory_startup=True)
    yield
    check(job.process.poll() is not None, "found the program after another file was opened")


def in_window(steps):
    """Runs the steps from a timer, with a window as context, and ends Blender."""
    def next_step():
        window = bpy.context.window_manager.windows[0]
        area = next(each for each in window.screen.areas if each.type == "VIEW_3D")
        try:
            with bpy.context.temp_override(window=window, area=area, region=area.regions[-1]):
                next(steps)
            return 0.05
        except StopIteration:
            print(f"{check.count} checks in a window", flush=True)
            os._exit(0)
        except BaseException:
            traceback.print_exc()
            sys.stderr.flush()
            os._exit(1)

    bpy.app.timers.register(next_step, first_interval=1, persistent=True)


if bpy.app.background:
    without_window()
    print(f"{check.count} checks in Blender {bpy.app.version_string}", flush=True)
else:
    in_window(window_steps(install()))
