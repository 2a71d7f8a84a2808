# SPDX-License-Identifier: MIT
# Godot 3 draws a level with ambient obscurance from a module that nook emitted.
extends Spatial

const SIZE = Vector2(640, 360)
var passes

func _ready():
	$camera.look_at_from_position(Vector3(2.6, 1.7, 0.6), Vector3(-5, 2.6, -48.4), Vector3.UP)
	$level.mesh = mesh_of("res://made/level.glb")
	passes = passes_of($camera, 1.5)
	add_child(passes[-1])
	$product.texture = passes[-1].get_texture() # multiplies what is drawn by visibility

# Reads the triangles of a file of `nook level`.
func mesh_of(path):
	var file = File.new()
	file.open(path, File.READ)
	file.seek(12)
	var length = file.get_32()
	file.seek(20)
	var json = parse_json(file.get_buffer(length).get_string_from_utf8())
	var mesh = ArrayMesh.new()
	for part in json.meshes:
		var arrays = []
		arrays.resize(Mesh.ARRAY_MAX)
		var given = part.primitives[0].attributes
		given.INDEX = part.primitives[0].indices
		for name in given:
			var accessor = json.accessors[given[name]]
			file.seek(28 + length + json.bufferViews[accessor.bufferView].byteOffset + accessor.byteOffset)
			var values = []
			for i in accessor.count:
				values.append(file.get_32() if name == "INDEX" else Vector3(file.get_float(), file.get_float(), file.get_float()))
			if name == "INDEX":
				values.invert() # Godot's front faces are clockwise
				arrays[Mesh.ARRAY_INDEX] = PoolIntArray(values)
			else:
				arrays[Mesh.ARRAY_VERTEX if name == "POSITION" else Mesh.ARRAY_NORMAL] = PoolVector3Array(values)
		mesh.add_surface_from_arrays(Mesh.PRIMITIVE_TRIANGLES, arrays)
	return mesh

# nook: viewports of the depth buffer and the passes. Each is a child of the next, because children are drawn before their parents.
func passes_of(camera, reach):
	var file = File.new()
	file.open("res://made/nook_vo.json", File.READ)
	var method = parse_json(file.get_as_text()).methods[0]
	var quad = MeshInstance.new() # on layer 2, which only this viewport's camera sees
	quad.mesh = QuadMesh.new()
	quad.mesh.material = material_of("res://depth.shader", {})
	quad.extra_cull_margin = 16384
	quad.layers = 2
	var eye = camera.duplicate()
	eye.cull_mask = camera.cull_mask | 2
	eye.add_child(quad)
	var depths = viewport_with([eye])
	depths.world = camera.get_world()
	depths.keep_3d_linear = true
	var uniforms = uniforms_of(camera, method.settings, reach)
	uniforms.nook_depths = depths.get_texture()
	uniforms.nook_vo_line_tile = tile_of(method.tile)
	var lines = viewport_with([rectangle_of("res://made/lines.shader", uniforms), depths])
	uniforms.nook_cells = lines.get_texture()
	var visibility = viewport_with([rectangle_of("res://made/window.shader", uniforms), lines])
	return [depths, lines, visibility]

func viewport_with(children):
	var result = Viewport.new()
	result.size = SIZE
	result.render_target_update_mode = Viewport.UPDATE_ALWAYS
	for child in children:
		result.add_child(child)
	return result

func rectangle_of(shader, uniforms):
	var result = ColorRect.new()
	result.rect_size = SIZE
	result.material = material_of(shader, uniforms)
	return result

func material_of(shader, uniforms):
	var result = ShaderMaterial.new()
	result.shader = load(shader)
	for name in uniforms:
		result.set_shader_param(name, uniforms[name])
	return result

func tile_of(tile):
	var bytes = StreamPeerBuffer.new()
	for number in tile.texels:
		bytes.put_float(number)
	var image = Image.new()
	image.create_from_data(tile.width, tile.height, false, Image.FORMAT_RGBAF, bytes.data_array)
	var result = ImageTexture.new()
	result.create_from_image(image, 0)
	return result

# The uniform block of nook_fill for a perspective camera, a depth buffer of 24 bits, and row 0 at the bottom.
func uniforms_of(camera, settings, reach):
	var up = tan(deg2rad(camera.fov) / 2)
	var result = {
		nook_size = SIZE,
		nook_pixel_size = Vector2(1, 1) / SIZE,
		nook_across_x = Vector2(up * SIZE.x / SIZE.y, 0),
		nook_across_y = Vector2(-up, 0),
		nook_w_slope = 1.0,
		nook_last = SIZE - Vector2(1, 1),
		nook_depth = Plane(camera.near, 0, camera.near / camera.far, 1 - camera.near / camera.far),
		nook_far_end = 1.0,
		nook_depth_step = (0.5 / 16777215 + pow(2, -25)) * (1 / camera.near - 1 / camera.far),
		nook_depth_share = 6 * pow(2, -24),
		nook_most_px = SIZE.y,
	}
	for name in settings:
		if not settings[name] is bool:
			result["nook_" + name] = settings[name].times_reach * reach if settings[name] is Dictionary else settings[name]
	return result
