# SPDX-License-Identifier: MIT
# Never run: no Godot 4 was available. An effect for the Compositor of a camera in Godot 4.3 and later, renderer Forward+: multiplies
# the picture of opaque objects by ambient obscurance from a module that nook emitted.
class_name NookEffect
extends CompositorEffect

@export var reach := 1.5 # length of the rays that the method approximates, metres
var projection := Projection.create_perspective(62, 16.0 / 9.0, 0.1, 200) # Camera3D.get_camera_projection(), when it changes

var module: Dictionary = JSON.parse_string(FileAccess.get_file_as_string("res://made/nook_vo.json"))
var device := RenderingServer.get_rendering_device()
var shaders: Array[RID] = []
var pipelines: Array[RID] = []
var pictures: Array[RID] = [] # of the module's passes
var drawn := Vector2i()
var sampler: RID
var block: RID
var tile: RID

func _init() -> void:
	effect_callback_type = EFFECT_CALLBACK_TYPE_POST_OPAQUE
	access_resolved_color = true
	access_resolved_depth = true
	RenderingServer.call_on_render_thread(prepare)

func prepare() -> void:
	for path: String in ["res://made/pass0.glsl", "res://made/pass1.glsl", "res://product.glsl"]:
		var file: RDShaderFile = load(path)
		shaders.append(device.shader_create_from_spirv(file.get_spirv()))
		pipelines.append(device.compute_pipeline_create(shaders[-1]))
	sampler = device.sampler_create(RDSamplerState.new())
	block = device.uniform_buffer_create(int(module.block.bytes))
	var samples: Dictionary = module.methods[0].tile
	tile = texture(Vector2i(int(samples.width), int(samples.height)), RenderingDevice.DATA_FORMAT_R32G32B32A32_SFLOAT,
			[PackedFloat32Array(samples.texels).to_byte_array()])

func _notification(what: int) -> void:
	if what == NOTIFICATION_PREDELETE:
		for id: RID in shaders + pictures + [sampler, block, tile]: # pipelines go with their shaders
			if id.is_valid():
				device.free_rid(id)

func _render_callback(_type: int, data: RenderData) -> void:
	var buffers: RenderSceneBuffersRD = data.get_render_scene_buffers()
	var size := buffers.get_internal_size()
	if size.x == 0 or size.y == 0 or shaders.size() < 3:
		return
	if size != drawn:
		for picture in pictures:
			device.free_rid(picture)
		pictures = [texture(size, RenderingDevice.DATA_FORMAT_R8_UNORM, []), texture(size, RenderingDevice.DATA_FORMAT_R8_UNORM, [])]
		drawn = size
	var bytes := block_of(size)
	device.buffer_update(block, 0, bytes.size(), bytes)
	var depths := buffers.get_depth_layer(0)
	var uniforms := uniform(RenderingDevice.UNIFORM_TYPE_UNIFORM_BUFFER, 0, [block])
	draw(0, size, [uniforms, read(1, depths), read(3, tile), read(6, tile), write(15, pictures[0])])
	draw(1, size, [uniforms, read(1, depths), read(3, tile), read(6, pictures[0]), write(15, pictures[1])])
	draw(2, size, [write(0, buffers.get_color_layer(0)), read(1, pictures[1])])

func draw(number: int, size: Vector2i, uniforms: Array[RDUniform]) -> void:
	var list := device.compute_list_begin()
	device.compute_list_bind_compute_pipeline(list, pipelines[number])
	device.compute_list_bind_uniform_set(list, UniformSetCacheRD.get_cache(shaders[number], 0, uniforms), 0)
	device.compute_list_dispatch(list, ceili(size.x / 8.0), ceili(size.y / 8.0), 1)
	device.compute_list_end()

func read(binding: int, id: RID) -> RDUniform:
	return uniform(RenderingDevice.UNIFORM_TYPE_SAMPLER_WITH_TEXTURE, binding, [sampler, id])

func write(binding: int, id: RID) -> RDUniform:
	return uniform(RenderingDevice.UNIFORM_TYPE_IMAGE, binding, [id])

func uniform(type: RenderingDevice.UniformType, binding: int, ids: Array[RID]) -> RDUniform:
	var result := RDUniform.new()
	result.uniform_type = type
	result.binding = binding
	for id in ids:
		result.add_id(id)
	return result

func texture(size: Vector2i, format: RenderingDevice.DataFormat, data: Array[PackedByteArray]) -> RID:
	var description := RDTextureFormat.new()
	description.format = format
	description.width = size.x
	description.height = size.y
	description.usage_bits = RenderingDevice.TEXTURE_USAGE_SAMPLING_BIT | RenderingDevice.TEXTURE_USAGE_STORAGE_BIT
	return device.texture_create(description, RDTextureView.new(), data)

# The block of nook_fill for a perspective camera, a reversed depth buffer of 32-bit floats, and row 0 at the top.
func block_of(size: Vector2i) -> PackedByteArray:
	var share := projection.get_z_near() / projection.get_z_far()
	var values := {
		size = [size.x, size.y],
		pixel_size = [1.0 / size.x, 1.0 / size.y],
		across_x = [1.0 / projection.x.x],
		across_y = [1.0 / projection.y.y],
		w_slope = [1.0],
		last = [size.x - 1, size.y - 1],
		depth = [projection.get_z_near(), 0.0, share, 1.0 - share],
		depth_share = [6.0 * pow(2, -24)],
		most_px = [size.y],
	}
	var settings: Dictionary = module.methods[0].settings
	for name: String in settings:
		if not settings[name] is bool:
			values[name] = [settings[name].times_reach * reach if settings[name] is Dictionary else settings[name]]
	var bytes := PackedByteArray()
	bytes.resize(int(module.block.bytes))
	for member: Dictionary in module.block.members:
		var numbers: Array = values.get(member.name, [])
		for i in numbers.size():
			bytes.encode_float(int(member.offset) + 4 * i, numbers[i])
	return bytes
