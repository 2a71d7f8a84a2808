# SPDX-License-Identifier: GPL-3.0-or-later
"""A Blender add-on that bakes ambient visibility of the selected objects into an attribute of their meshes with the program nook.

It writes the geometry to a temporary file, runs `nook bake`, and reads one value per vertex or face corner. It writes no other
file. docs/guide/darker_creases.md describes it for users.
"""

import json
import os
import shutil
import struct
import subprocess
import tempfile

import bpy
import numpy as np
from bpy.props import EnumProperty, FloatProperty, IntProperty, PointerProperty, StringProperty

bl_info = {
    "name": "nook: bake ambient visibility",
    "author": "The nook authors",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "3D View > Sidebar > nook",
    "description": "Bakes ambient visibility, traced by the program nook, into the selected meshes",
    "category": "Object",
}

FLOAT_NAME = "_VISIBILITY"  # exporters of glTF keep attributes whose names start with _
SURFACES = {"MESH", "CURVE", "SURFACE", "FONT", "META"}
Y_UP = np.array([[1, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]], np.float64)  # from Blender's z up to that of glTF


class Refused(Exception):
    """One line for the user: what was found, and what was expected."""


def program_path(context):
    """Returns the program named in the preferences, or the one on PATH; None if there is none."""
    addon = context.preferences.addons.get(__name__)
    given = bpy.path.abspath(addon.preferences.program) if addon else ""
    return shutil.which(given or "nook")


def column(collection, name, width, dtype):
    """Returns one property of all items of a collection as rows of an array."""
    values = np.empty(len(collection) * width, dtype)
    collection.foreach_get(name, values)
    return values.reshape(-1, width) if width > 1 else values


def corner_normals(mesh):
    if hasattr(mesh, "corner_normals"):  # since Blender 4.1
        return column(mesh.corner_normals, "vector", 3, np.float32)
    mesh.calc_normals_split()
    return column(mesh.loops, "normal", 3, np.float32)


def topology(mesh):
    """Returns the vertices of all face corners and the faces' sizes. Values of one mesh fit any mesh for which these are equal."""
    return column(mesh.loops, "vertex_index", 1, np.int32).tobytes(), column(mesh.polygons, "loop_total", 1, np.int32).tobytes()


def geometry(mesh, domain):
    """Returns positions, normals and triangles, with one vertex per vertex of the mesh (POINT) or per face corner (CORNER).

    Corners with equal normals at one place share a value, because nook fits them together; hard edges stay sharp.
    """
    mesh.calc_loop_triangles()
    positions = column(mesh.vertices, "co", 3, np.float32)
    if domain == "POINT":
        return positions, column(mesh.vertices, "normal", 3, np.float32), column(mesh.loop_triangles, "vertices", 3, np.int32)
    of_corner = column(mesh.loops, "vertex_index", 1, np.int32)
    return positions[of_corner], corner_normals(mesh), column(mesh.loop_triangles, "loops", 3, np.int32)


class Level:
    """A binary glTF file of meshes at places, in the order in which they are added."""

    def __init__(self):
        self.binary = bytearray()
        self.json = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": []}], "nodes": [], "meshes": [], "accessors": [],
                     "bufferViews": [], "buffers": []}

    def accessor(self, array, kind, component, **more):
        self.json["bufferViews"].append({"buffer": 0, "byteOffset": len(self.binary), "byteLength": array.nbytes})
        self.binary += array.tobytes()
        self.json["accessors"].append({"bufferView": len(self.json["bufferViews"]) - 1, "componentType": component,
                                       "count": array.size // kind[1], "type": kind[0], **more})
        return len(self.json["accessors"]) - 1

    def mesh(self, name, positions, normals, triangles):
        if not np.isfinite(positions).all():
            raise Refused(f"{name}: found a vertex that is not finite, expected numbers")
        box = {"min": positions.min(0).tolist(), "max": positions.max(0).tolist()}
        attributes = {"POSITION": self.accessor(positions, ("VEC3", 3), 5126, **box),
                      "NORMAL": self.accessor(normals, ("VEC3", 3), 5126)}
        indices = self.accessor(triangles.astype(np.uint32), ("SCALAR", 1), 5125)
        self.json["meshes"].append({"primitives": [{"attributes": attributes, "indices": indices}]})
        return len(self.json["meshes"]) - 1

    def place(self, mesh, matrix_world, name, **extras):
        matrix = Y_UP @ np.array(matrix_world)
        if not np.isfinite(matrix).all():
            raise Refused(f"{name}: found a transform that is not finite, expected numbers")
        self.json["scenes"][0]["nodes"].append(len(self.json["nodes"]))
        self.json["nodes"].append({"mesh": mesh, "name": name, "matrix": matrix.T.ravel().tolist(), "extras": extras})

    def write(self, path):
        self.json["buffers"].append({"byteLength": len(self.binary)})
        text = json.dumps(self.json).encode()
        text += b" " * (-len(text) % 4)
        with open(path, "wb") as file:
            file.write(struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(self.binary)))
            file.write(struct.pack("<I4s", len(text), b"JSON") + text)
            file.write(struct.pack("<I4s", len(self.binary), b"BIN\0") + self.binary)


def target_of(mesh, target, name):
    """Returns the existing attribute that gets the values, or None if it has to be made. Refuses one of another type or domain."""
    if target == "ALPHA" and mesh.color_attributes.active_color:
        return mesh.color_attributes.active_color
    attribute = mesh.attributes.get(FLOAT_NAME if target == "FLOAT" else name)
    types = {"FLOAT"} if target == "FLOAT" else {"FLOAT_COLOR", "BYTE_COLOR"}
    if attribute and (attribute.data_type not in types or attribute.domain not in {"POINT", "CORNER"}):
        raise Refused(f"{mesh.name}: {attribute.name}: found {attribute.data_type} per {attribute.domain}, expected "
                      f"{' or '.join(sorted(types))} per POINT or CORNER")
    return attribute


def store(mesh, target, name, values):
    """Writes one value per item of the attribute's domain."""
    attribute = target_of(mesh, target, name)
    if target == "FLOAT":
        attribute = attribute or mesh.attributes.new(FLOAT_NAME, "FLOAT", "CORNER")
        attribute.data.foreach_set("value", values)
    else:
        made = attribute is None
        if made:
            attribute = mesh.color_attributes.new(name, "FLOAT_COLOR", "CORNER")
        colors = np.ones((len(values), 4), np.float32)
        if target == "ALPHA":
            if not made:
                attribute.data.foreach_get("color", colors.reshape(-1))
            colors[:, 3] = values
        else:
            colors[:, :3] = values[:, None]
        attribute.data.foreach_set("color", colors.reshape(-1))
        mesh.color_attributes.active_color = attribute
    mesh.update()


class Job:
    """One bake: the geometry in a temporary folder, and the program that works on it.

    It keeps names of meshes and no references, because Blender frees what they refer to when the user undoes a step meanwhile.
    """

    def __init__(self, context, settings):
        self.notes = []  # warnings, one line each
        self.stage, self.done = "", 0.0
        self.receivers = []  # (mesh's name, its topology, number of values)
        self.target, self.name = settings.target, settings.name.strip()
        if not self.name and self.target != "FLOAT":
            raise Refused("Attribute: found no name, expected one")
        program = program_path(context)
        if not program:
            raise Refused("nook: found no such program, expected its path in the add-on's preferences, or nook on PATH")
        level = self.level_of(context, settings.occluders == "SELECTED")
        self.folder = tempfile.mkdtemp(prefix="nook-", dir=bpy.app.tempdir or None)
        try:
            level.write(self.path("scene.glb"))
            with open(self.path("errors"), "wb") as errors:
                self.process = subprocess.Popen(
                    [program, "bake", "scene.glb", "--radius", f"{settings.radius:.7g}", "--rays", str(settings.rays),
                     "--receivers", "extras:receives", "-o", "values.npy", "--progress", "progress"],
                    cwd=self.folder, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=errors)
        except OSError as error:
            shutil.rmtree(self.folder, ignore_errors=True)
            raise Refused(f"{program}: {error.strerror}") from None

    def path(self, name):
        return os.path.join(self.folder, name)

    def level_of(self, context, selected_only):
        """Adds the selected meshes in the order of self.receivers, then everything else that occludes."""
        depsgraph = context.evaluated_depsgraph_get()
        level = Level()
        chosen = set(context.selected_objects)
        receiving = set()
        for item in sorted(chosen, key=lambda each: each.name_full):
            if item.type in SURFACES and item.type != "MESH":
                self.notes.append(f"{item.name}: is not a mesh, so it occludes but gets no values")
            elif item.type == "MESH" and self.receive(item, depsgraph, level):
                receiving.add(item)
        if not self.receivers:
            raise Refused("; ".join(self.notes) or "Found no selected object, expected meshes with faces")
        meshes = [name for name, _, _ in self.receivers]
        for name in sorted(set(meshes)):
            users = bpy.data.meshes[name, None].users
            if users > 1:
                self.notes.append(f"{name}: has {users} users, which all get the mean of the {meshes.count(name)} selected; "
                                  "Object > Relations > Make Single User gives each its own")

        known = {}
        for place in depsgraph.object_instances:
            owner = (place.parent if place.is_instance else place.object).original
            item = place.object
            if item.type not in SURFACES or owner.hide_render or not owner.visible_get() or (selected_only and owner not in chosen):
                continue
            if not place.is_instance and owner in receiving:
                continue
            key = item.data.as_pointer() if item.type == "MESH" else None
            if key is None or key not in known:
                mesh = item.to_mesh()
                known[key] = level.mesh(owner.name, *geometry(mesh, "POINT")) if mesh and len(mesh.polygons) > 0 else None
                item.to_mesh_clear()
            if known[key] is not None:
                level.place(known[key], place.matrix_world, owner.name)
        return level

    def receive(self, item, depsgraph, level):
        """Adds a selected mesh, with its modifiers if these keep its vertices and faces. Returns whether it gets values."""
        mesh = item.data
        if len(mesh.polygons) == 0:
            self.notes.append(f"{item.name}: has no faces, so it gets no values")
            return False
        if mesh.library or mesh.override_library:
            self.notes.append(f"{item.name}: its mesh is in another file, so it gets no values")
            return False
        attribute = target_of(mesh, self.target, self.name)
        domain = attribute.domain if attribute else "CORNER"
        shape = topology(mesh)
        for source in (item.evaluated_get(depsgraph), item):
            shown = source.to_mesh()
            fits = topology(shown) == shape
            if fits:
                arrays = geometry(shown, domain)
                level.place(level.mesh(item.name, *arrays), source.matrix_world, item.name, receives=True)
                self.receivers.append((mesh.name, shape, len(arrays[0])))
            source.to_mesh_clear()
            if fits:
                return True
            self.notes.append(f"{item.name}: modifiers change its faces, so it is baked without them; "
                              "apply them for a bake with them")
        raise Refused(f"{item.name}: found a mesh that changes while it is read, expected object mode")

    def running(self):
        """Reads how far the program is. Returns whether it still works."""
        working = self.process.poll() is None
        try:
            with open(self.path("progress"), encoding="utf-8") as file:
                lines = [line for line in file.read().split("\n")[1:-1] if '"stage"' in line]
        except OSError:
            lines = []
        if lines:
            last = json.loads(lines[-1])
            self.stage, self.done = last["stage"], last["done"]
        return working

    def finish(self):
        """Writes the values into the meshes. Returns one line about them."""
        try:
            with open(self.path("errors"), encoding="utf-8", errors="replace") as file:
                said = [line.strip() for line in file if line.strip()]
            if self.process.returncode != 0:
                raise Refused(said[-1] if said else f"nook: ended with {self.process.returncode}, expected 0")
            self.notes += said
            try:
                values = np.load(self.path("values.npy"), allow_pickle=False)
            except (OSError, ValueError):
                raise Refused(f"{self.process.args[0]}: wrote no values, expected the program nook") from None
        finally:
            shutil.rmtree(self.folder, ignore_errors=True)

        sums = {}
        at = 0
        for name, shape, count in self.receivers:
            total, places, _ = sums.get(name, (0, 0, None))
            sums[name] = total + values[at:at + count].astype(np.float64), places + 1, shape
            at += count
        written = 0
        for name, (total, places, shape) in sums.items():
            try:
                mesh = bpy.data.meshes.get((name, None))
                if not mesh or mesh.is_editmode or topology(mesh) != shape:
                    raise Refused(f"{name}: changed during the bake, so it gets no values")
                attribute = target_of(mesh, self.target, self.name)
                if len(total) != len(attribute.data if attribute else mesh.loops):
                    raise Refused(f"{name}: its attribute changed during the bake, so it gets no values")
                store(mesh, self.target, self.name, (total / places).astype(np.float32))
                written += len(total)
            except Refused as refused:
                self.notes.append(str(refused))
        return f"nook: baked {written} values"

    def stop(self):
        """Ends the program, and removes what it has written."""
        if self.process.poll() is None:
            self.process.terminate()
            try:
                self.process.wait(5)
            except subprocess.TimeoutExpired:
                self.process.kill()
                self.process.wait()
        shutil.rmtree(self.folder, ignore_errors=True)


running_job = None  # at most one


class NOOK_OT_bake(bpy.types.Operator):
    """Bakes the selected meshes. Blender stays usable meanwhile; a script that calls this waits for the result"""
    bl_idname = "nook.bake"
    bl_label = "Bake"
    bl_options = {"UNDO"}

    @classmethod
    def poll(cls, context):
        if context.mode != "OBJECT":
            cls.poll_message_set("Leave edit mode first")
        return context.mode == "OBJECT" and running_job is None

    def start(self, context):
        global running_job
        try:
            running_job = Job(context, context.scene.nook_bake)
        except Refused as refused:
            self.report({"ERROR"}, str(refused))
        return running_job is not None

    def end(self, context):
        global running_job
        job, running_job = running_job, None
        try:
            said = job.finish()
        except Refused as refused:
            self.report({"ERROR"}, str(refused))
            return {"CANCELLED"}
        for note in job.notes:
            self.report({"WARNING"}, note)
        self.report({"INFO"}, said)
        return {"FINISHED"}

    def execute(self, context):
        if not self.start(context):
            return {"CANCELLED"}
        running_job.process.wait()
        return self.end(context)

    def invoke(self, context, event):
        if not self.start(context):
            return {"CANCELLED"}
        self.timer = context.window_manager.event_timer_add(0.1, window=context.window)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        if event.type != "TIMER":
            return {"PASS_THROUGH"}
        if running_job is not None and running_job.running():
            redraw(context)
            return {"PASS_THROUGH"}
        context.window_manager.event_timer_remove(self.timer)
        redraw(context)
        if running_job is None:
            self.report({"INFO"}, "nook: cancelled")
            return {"CANCELLED"}
        return self.end(context)

    def cancel(self, context):
        """Blender calls this where it ends the operator itself, as when another file is opened."""
        context.window_manager.event_timer_remove(self.timer)
        stop_job()


class NOOK_OT_cancel(bpy.types.Operator):
    """Ends the program; the meshes stay as they are"""
    bl_idname = "nook.cancel"
    bl_label = "Cancel"

    @classmethod
    def poll(cls, context):
        return running_job is not None

    def execute(self, context):
        stop_job()
        return {"FINISHED"}


def stop_job():
    global running_job
    if running_job is not None:
        running_job.stop()
        running_job = None


def redraw(context):
    for window in context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()


class NOOK_PT_panel(bpy.types.Panel):
    bl_label = "Ambient visibility"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "nook"

    def draw(self, context):
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        settings = context.scene.nook_bake
        rows = layout.column()
        rows.enabled = running_job is None
        rows.prop(settings, "radius")
        rows.prop(settings, "rays")
        rows.prop(settings, "occluders")
        rows.prop(settings, "target")
        if settings.target != "FLOAT":
            rows.prop(settings, "name")
        if running_job is not None:
            layout.label(text=f"{running_job.stage}: {running_job.done:.0%}", icon="TIME")
            layout.operator("nook.cancel", icon="CANCEL")
        elif program_path(context):
            layout.operator("nook.bake", icon="SHADING_RENDERED")
        else:
            layout.label(text="Found no program nook", icon="ERROR")
            layout.operator("preferences.addon_show", text="Set its path").module = __name__


class NookPreferences(bpy.types.AddonPreferences):
    bl_idname = __name__

    program: StringProperty(name="Program", subtype="FILE_PATH", description="The program nook; empty: the one on PATH")

    def draw(self, context):
        self.layout.prop(self, "program")


class NookSettings(bpy.types.PropertyGroup):
    radius: FloatProperty(name="Radius", subtype="DISTANCE", default=1.0, min=0.0, soft_max=100.0,
                          description="How far surfaces darken each other: the length of the rays")
    rays: IntProperty(name="Rays", default=256, min=1, max=16384, description="Rays per value: more give less noise")
    occluders: EnumProperty(name="Occluders", items=[
        ("SELECTED", "Selected", "Only selected objects darken"),
        ("VISIBLE", "Visible", "All objects that the viewport and renders show darken; only selected ones get values")],
        default="VISIBLE")
    target: EnumProperty(name="Target", items=[
        ("COLOR", "Color", "A colour attribute: visibility as grey"),
        ("ALPHA", "Color Alpha", "The alpha of the active colour attribute; a new white one if there is none"),
        ("FLOAT", FLOAT_NAME, f"The float attribute {FLOAT_NAME}, for shaders of your own")])
    name: StringProperty(name="Attribute", default="Visibility",
                         description="Name of the colour attribute, which is made or replaced")


CLASSES = (NookPreferences, NookSettings, NOOK_OT_bake, NOOK_OT_cancel, NOOK_PT_panel)


def register():
    for each in CLASSES:
        bpy.utils.register_class(each)
    bpy.types.Scene.nook_bake = PointerProperty(type=NookSettings)


def unregister():
    stop_job()
    del bpy.types.Scene.nook_bake
    for each in reversed(CLASSES):
        bpy.utils.unregister_class(each)


if __name__ == "__main__":
    register()
