// SPDX-License-Identifier: GPL-3.0-or-later
// This work is based on: Khronos Group, "glTF 2.0 Specification", ISO/IEC 12113:2022, sections 3.8 and 3.9.
#include "scene/glb_materials.h"

#include "core/image.h"

namespace nook
{
namespace
{

using Json = nlohmann::ordered_json;

int wrapCode(Wrap wrap)
{
	return wrap == Wrap::clamp ? 33071 : wrap == Wrap::mirror ? 33648 : 10497;
}

} // namespace

GlbMaterials::GlbMaterials(const Level& level, std::string_view occlusion_png)
	: m_level(level), m_occlusion_png(occlusion_png), m_material(level.material_list.size(), -1), m_mask(level.masks.size(), -1)
{
}

int GlbMaterials::indexOf(uint32_t index)
{
	int& made = m_material[index];
	if (made >= 0)
	{
		return made;
	}
	made = static_cast<int>(materials.size());
	const Material& material = m_level.material_list[index];
	Json item{{"name", material.name}};
	if (material.alpha_mode != AlphaMode::opaque)
	{
		item["alphaMode"] = material.alpha_mode == AlphaMode::mask ? "MASK" : "BLEND";
		item["pbrMetallicRoughness"]["baseColorFactor"] = {1.0, 1.0, 1.0, material.alpha};
		if (material.alpha_mode == AlphaMode::mask)
		{
			item["alphaCutoff"] = material.cutoff;
		}
		if (material.mask >= 0)
		{
			item["pbrMetallicRoughness"]["baseColorTexture"]["index"] = textureOf(static_cast<std::size_t>(material.mask));
		}
	}
	if (!m_occlusion_png.empty())
	{
		item["occlusionTexture"] = {{"index", occlusionTexture()}, {"texCoord", material.mask >= 0 ? 1 : 0}};
	}
	item["doubleSided"] = material.two_sided;
	materials.push_back(item);
	return made;
}

// Texture, sampler and image share one number.
int GlbMaterials::occlusionTexture()
{
	if (m_occlusion < 0)
	{
		m_occlusion = static_cast<int>(textures.size());
		textures.push_back({{"sampler", m_occlusion}, {"source", m_occlusion}});
		samplers.push_back(
			{{"magFilter", 9729}, {"minFilter", 9987}, {"wrapS", wrapCode(Wrap::clamp)}, {"wrapT", wrapCode(Wrap::clamp)}});
		images.push_back({{"name", "visibility"}, {"mimeType", "image/png"}});
		pictures.emplace_back(m_occlusion_png);
	}
	return m_occlusion;
}

int GlbMaterials::textureOf(std::size_t index)
{
	int& made = m_mask[index];
	if (made < 0)
	{
		made = static_cast<int>(textures.size());
		const Mask& mask = m_level.masks[index];
		textures.push_back({{"sampler", made}, {"source", made}});
		const int filter = mask.nearest ? 9728 : 9729;
		samplers.push_back(
			{{"magFilter", filter}, {"minFilter", filter}, {"wrapS", wrapCode(mask.wrap_u)}, {"wrapT", wrapCode(mask.wrap_v)}});
		images.push_back({{"name", mask.name}, {"mimeType", "image/png"}});
		pictures.push_back(alphaPngBytes(mask.width_px, mask.height_px, mask.alpha));
	}
	return made;
}

} // namespace nook
