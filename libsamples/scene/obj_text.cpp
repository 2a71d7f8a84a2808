// SPDX-License-Identifier: GPL-3.0-or-later
// This work is based on: Wavefront Technologies, Advanced Visualizer manual, appendix B1, Object Files (.obj), and the MTL format
// beside it.
#include "scene/mesh_text.h"

#include "core/lists.h"
#include "core/system.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>

namespace nook
{
namespace
{

class ObjReader
{
public:
	ObjReader(const std::string& path, const LoadSettings& settings) : m_path(path), m_settings(settings)
	{
		m_file.materials.number(kNoMaterial);
		m_file.meshes.emplace_back().name = "defaultobject";
	}

	MeshFile run(const std::string& text)
	{
		const auto each = [&](const auto& take)
		{
			forLines(text, m_path, true,
					 [&](std::string_view line, const TextPlace& place)
					 {
						 splitWords(line, m_words);
						 if (!m_words.empty())
						 {
							 take(m_words[0], place);
						 }
					 });
		};
		each([&](std::string_view keyword, const TextPlace& place) { takeNumbers(keyword, place); }); // faces may precede them
		each([&](std::string_view keyword, const TextPlace& place) { takeElement(keyword, place); });
		std::erase_if(m_file.meshes, [](const FileMesh& mesh) { return mesh.ends.empty(); });
		m_file.vertices = m_positions.size();
		return std::move(m_file);
	}

private:
	void takeNumbers(std::string_view keyword, const TextPlace& place)
	{
		if (keyword != "v" && keyword != "vt" && keyword != "vn")
		{
			return;
		}
		dropComment();
		std::array<double, 8> numbers{};
		const std::size_t count = m_words.size() - 1;
		for (std::size_t i = 0; i < count; ++i)
		{
			numbers[std::min(i, numbers.size() - 1)] = place.number(m_words[i + 1]);
		}
		const glm::dvec3 point(numbers[0], numbers[1], numbers[2]);
		if (keyword == "vt" ? count < 1 || count > 3 : count != 3 && (keyword == "vn" || (count != 4 && count != 6 && count != 7)))
		{
			place.fail(std::to_string(count) + " numbers", keyword == "v"    ? "x y z, a weight behind them or a colour"
														   : keyword == "vn" ? "x y z"
																			 : "u, u v or u v w");
		}
		if (keyword == "vt")
		{
			m_uvs.emplace_back(point);
		}
		else if (keyword == "vn")
		{
			m_normals.emplace_back(point);
		}
		else if (count == 4 && numbers[3] == 0.0)
		{
			place.fail("a weight of 0", "another");
		}
		else
		{
			m_positions.push_back(count == 4 ? point / numbers[3] : point);
			if (count > 4)
			{
				m_colours.resize(m_positions.size(), glm::vec3(1.0F));
				m_colours.back() = linearOf({numbers[3], numbers[4], numbers[5]});
			}
		}
	}

	void dropComment()
	{
		m_words.erase(std::find_if(m_words.begin(), m_words.end(), [](std::string_view word) { return word.starts_with('#'); }),
					  m_words.end());
	}

	void takeElement(std::string_view keyword, const TextPlace& place)
	{
		const std::string name = m_words.size() > 1 ? textFrom(m_words, 1) : "";
		if (keyword == "v" || keyword == "vt" || keyword == "vn")
		{
			m_before[keyword == "v" ? 0 : keyword == "vt" ? 1 : 2] += 1;
		}
		else if (keyword == "f" || keyword == "l" || keyword == "p")
		{
			addFaces(keyword, place);
		}
		else if (keyword == "g" || keyword == "o")
		{
			std::string& current = keyword == "g" ? m_group : m_object;
			if (name != current)
			{
				start(name).name = name;
				current = name;
			}
		}
		else if (keyword == "usemtl" && !name.empty())
		{
			const uint32_t material = m_file.materials.number(name);
			if (material != m_material)
			{
				m_material = material;
				start(name);
			}
		}
		else if (keyword == "mtllib" && !name.empty())
		{
			takeLibrary(name);
		}
		// Curves and surfaces are not supported.
	}

	// The mesh for the next faces; it has the name only if it is new.
	FileMesh& start(const std::string& name)
	{
		if (!m_file.meshes.back().ends.empty())
		{
			m_file.meshes.emplace_back().name = name;
		}
		m_file.meshes.back().material = m_material;
		return m_file.meshes.back();
	}

	void addFaces(std::string_view keyword, const TextPlace& place)
	{
		dropComment();
		FileMesh& mesh = m_file.meshes.back();
		const auto first = static_cast<uint32_t>(mesh.positions.size());
		for (std::size_t i = 1; i < m_words.size(); ++i)
		{
			addCorner(m_words[i], place, mesh);
		}
		const auto count = static_cast<uint32_t>(m_words.size() - 1);
		const uint32_t size = keyword == "f" ? count : keyword == "l" ? 2 : 1;
		for (uint32_t i = 0; i < count && i + size <= count; i += keyword == "f" ? count : 1)
		{
			for (uint32_t corner = 0; corner < size; ++corner)
			{
				mesh.corners.push_back(first + i + corner);
			}
			mesh.ends.push_back(static_cast<uint32_t>(mesh.corners.size()));
		}
	}

	// "1", "1/2", "1//3" or "1/2/3". Coordinates and normals that the file lacks count as missing.
	void addCorner(std::string_view word, const TextPlace& place, FileMesh& mesh) const
	{
		constexpr std::size_t kMissing = SIZE_MAX;
		std::array<std::size_t, 3> indices{kMissing, kMissing, kMissing};
		std::size_t parts = 0;
		for (std::size_t begin = 0; begin <= word.size(); ++parts)
		{
			const std::size_t end = std::min(word.find('/', begin), word.size());
			const std::string_view part = word.substr(begin, end - begin);
			const std::optional<int> index = wholeOf(part);
			if (parts > 2 || index == 0 || (!index && (parts == 0 || !part.empty())))
			{
				place.fail(quoted(word), "an index, or two or three with / between them");
			}
			if (index) // a negative one counts back from here
			{
				indices[parts] = *index > 0 ? static_cast<std::size_t>(*index) - 1
											: m_before[parts] - static_cast<std::size_t>(-int64_t{*index});
			}
			begin = end + 1;
		}
		if (indices[0] >= m_positions.size())
		{
			place.fail(quoted(word), "one of " + std::to_string(m_positions.size()) + " vertices");
		}
		if (indices[1] < m_uvs.size())
		{
			mesh.uvs.resize(mesh.positions.size(), glm::vec2(0.0F));
			mesh.uvs.push_back(m_uvs[indices[1]]);
		}
		if (indices[2] < m_normals.size())
		{
			mesh.normals.resize(mesh.positions.size(), glm::vec3(0.0F));
			mesh.normals.push_back(m_normals[indices[2]]);
		}
		if (!m_colours.empty())
		{
			mesh.colours.push_back(indices[0] < m_colours.size() ? m_colours[indices[0]] : glm::vec3(1.0F));
		}
		mesh.sources.push_back(static_cast<uint32_t>(indices[0]));
		mesh.positions.push_back(m_positions[indices[0]]);
	}

	// Without this MTL file, takes one that has the level's name.
	void takeLibrary(const std::string& name)
	{
		const auto is_file = [](const std::string& path)
		{
			std::error_code failed;
			return std::filesystem::is_regular_file(nativePath(path), failed);
		};
		std::string path = besideLevel(m_path, name);
		if (!is_file(path))
		{
			addOnce(m_file.missing, path);
			path = nativePath(m_path).replace_extension(".mtl").string();
		}
		if (is_file(path) && std::find(m_file.files.begin(), m_file.files.end(), path) == m_file.files.end())
		{
			checkInside(m_path, "mtllib", path, m_settings);
			m_file.files.push_back(path);
			readMtl(readMeshText(path), path, m_file.materials);
		}
	}

	const std::string& m_path;
	const LoadSettings& m_settings;
	MeshFile m_file;
	std::vector<std::string_view> m_words; // of the line
	std::vector<glm::dvec3> m_positions;
	std::vector<glm::vec2> m_uvs;
	std::vector<glm::vec3> m_normals;
	std::vector<glm::vec3> m_colours;      // of the first positions
	std::array<std::size_t, 3> m_before{}; // how many of these precede the line
	std::string m_group;
	std::string m_object;
	uint32_t m_material = 0;
};

// This work is based on: Diane Ramey, Linda Rose, Lisa Tyerman, "MTL material format (Lightwave, OBJ)", Alias|Wavefront 1995.

// A line that references a picture: "map_d -s 2 2 1 -clamp on a leaf.png".
class PictureLine
{
public:
	PictureLine(const std::vector<std::string_view>& words, const TextPlace& place) : m_words(words), m_place(place) {}

	// `ignored`: becomes the first unsupported option.
	PlacedPicture read(std::string& ignored)
	{
		PlacedPicture picture;
		picture.channel = MaskChannel::alpha_or_first;
		while (m_at < m_words.size() && m_words[m_at].starts_with('-'))
		{
			m_option = lowered(m_words[m_at++]);
			ignored = take(picture) && ignored.empty() ? m_option : ignored;
		}
		failIf(m_at >= m_words.size(), m_place, "nothing", "the name of a file behind " + std::string(m_words[0]));
		picture.name = textFrom(m_words, m_at);
		// v grows upward in the file and downward in a level.
		picture.uv_of_set[0][0] = m_scale[0];
		picture.uv_of_set[1][1] = m_scale[1];
		picture.uv_of_set[2] = {m_offset[0], 1.0 - m_scale[1] - m_offset[1], 1.0};
		return picture;
	}

private:
	// Reads one option; true if it changes the picture and is not supported.
	bool take(MaskSource& mask)
	{
		constexpr std::array<std::string_view, 3> kSwitches{"-blendu", "-blendv", "-cc"};
		if (m_option == "-s" || m_option == "-o" || m_option == "-t")
		{
			return takeVector();
		}
		if (m_option == "-mm")
		{
			mask.base = number();
			mask.gain = number();
			return false;
		}
		if (m_option == "-clamp")
		{
			mask.wrap_u = mask.wrap_v = isOn() ? Wrap::clamp : Wrap::repeat;
			return false;
		}
		if (m_option == "-imfchan")
		{
			mask.channel = channel();
			return false;
		}
		if (std::find(kSwitches.begin(), kSwitches.end(), m_option) != kSwitches.end())
		{
			return isOn() == (m_option == "-cc"); // by default blending is on and colour correction off
		}
		if (m_option == "-bm" || m_option == "-boost" || m_option == "-texres")
		{
			return number() != 1.0 || m_option == "-texres";
		}
		if (m_option == "-type")
		{
			word("a kind of reflection");
			return true;
		}
		m_place.fail(nook::quoted(m_option), "an option of MTL, or the name of a file");
	}

	// One to three numbers; missing ones keep their values.
	bool takeVector()
	{
		std::array<double, 3> unused{};
		std::array<double, 3>& to = m_option == "-s" ? m_scale : m_option == "-o" ? m_offset : unused;
		to[0] = number();
		for (std::size_t i = 1; i < to.size() && m_at < m_words.size() && numberOf(m_words[m_at]); ++i)
		{
			to[i] = number();
		}
		failIf(m_option == "-s" && (to[0] == 0.0 || to[1] == 0.0), m_place, "a scale of 0", "another number behind -s");
		return m_option == "-t" && (to[0] != 0.0 || to[1] != 0.0);
	}

	std::string_view word(const std::string& expected)
	{
		failIf(m_at >= m_words.size(), m_place, "nothing", expected + " behind " + m_option);
		return m_words[m_at++];
	}

	double number()
	{
		const std::string_view text = word("a number");
		const double value = numberOf(text).value_or(NAN);
		failIf(!(std::fabs(value) <= kMaxNumber), m_place, nook::quoted(text), "a number behind " + m_option);
		return value;
	}

	bool isOn()
	{
		const std::string text = lowered(word("on or off"));
		failIf(text != "on" && text != "off", m_place, nook::quoted(text), "on or off behind " + m_option);
		return text == "on";
	}

	MaskChannel channel()
	{
		const std::string text = lowered(word("a channel"));
		switch (text.size() == 1 ? text[0] : '\0')
		{
		case 'r': return MaskChannel::red;
		case 'g': return MaskChannel::green;
		case 'b': return MaskChannel::blue;
		case 'm': return MaskChannel::alpha;
		case 'l': return MaskChannel::luminance;
		case 'z': m_place.fail("the channel z", "r, g, b, m or l: no depth is read of pictures", ExitCode::unsupported);
		default: m_place.fail(nook::quoted(text), "r, g, b, m, l or z behind -imfchan");
		}
	}

	static constexpr double kMaxNumber = 1e9; // beyond any texture; 32-bit coordinates have no precision left

	const std::vector<std::string_view>& m_words;
	const TextPlace& m_place;
	std::size_t m_at = 1;
	std::string m_option;
	std::array<double, 3> m_scale{1.0, 1.0, 1.0};
	std::array<double, 3> m_offset{};
};

float shareIn(const std::vector<std::string_view>& words, const TextPlace& place)
{
	const std::size_t at = words.size() > 1 && words[1] == "-halo" ? 2 : 1; // ignores how -halo depends on the view
	failIf(at >= words.size(), place, "nothing", "a number");
	const double value = place.number(words[at]);
	failIf(!(value >= 0.0 && value <= 1.0), place, quoted(words[at]), "0 to 1 behind " + std::string(words[0]));
	return static_cast<float>(value);
}

// Colours decide no shape, so their defects are not errors.
PlacedPicture colourOf(const std::vector<std::string_view>& words, const TextPlace& place)
{
	try
	{
		std::string any;
		return PictureLine(words, place).read(any);
	}
	catch (const Error&)
	{
		return {};
	}
}

// "Kd 0.8 0.8 0.8"; white for curves and other colour spaces.
glm::vec3 diffuseOf(const std::vector<std::string_view>& words)
{
	glm::vec3 colour(1.0F);
	for (std::size_t i = 1; i < 4 && words.size() == 4; ++i)
	{
		const double value = numberOf(words[i]).value_or(1.0);
		colour[static_cast<int>(i) - 1] = value >= 0.0 && value <= 1.0 ? static_cast<float>(value) : 1.0F;
	}
	return colour;
}

} // namespace

MeshFile readObj(const std::string& text, const std::string& path, const LoadSettings& settings)
{
	return ObjReader(path, settings).run(text);
}

void readMtl(const std::string& text, const std::string& path, MtlMaterials& materials)
{
	MtlMaterial before; // for lines before the first name
	MtlMaterial* material = &before;
	std::vector<std::string_view> words;
	const auto take = [&](std::string_view line, const TextPlace& place)
	{
		splitWords(line, words);
		const std::string keyword = words.empty() ? "" : lowered(words[0]);
		if (keyword == "newmtl")
		{
			material = &materials.list[materials.number(words.size() > 1 ? textFrom(words, 1) : kNoMaterial)];
		}
		else if (keyword == "d" || keyword == "tr")
		{
			(keyword == "d" ? material->d : material->tr) = shareIn(words, place);
		}
		else if (keyword == "map_d")
		{
			material->ignored.clear();
			material->opacity = PictureLine(words, place).read(material->ignored);
		}
		else if (keyword == "map_kd")
		{
			material->picture = colourOf(words, place);
		}
		else if (keyword == "kd")
		{
			material->colour = diffuseOf(words);
		}
	};
	forLines(text, path, false, take);
}

float opacityOf(const MtlMaterial& material, TrMeaning meaning, bool& inverted)
{
	constexpr float kRounding = 1e-3F; // for three digits, as programs write them
	const float by_format = 1.0F - material.tr.value_or(0.0F);
	const float by_tr = meaning == TrMeaning::opacity ? material.tr.value_or(1.0F) : by_format;
	if (material.d)
	{
		inverted = material.tr && std::fabs(*material.d - by_tr) > kRounding;
		return *material.d;
	}
	// Nobody models an invisible surface: the program wrote opacity as Tr.
	inverted = meaning == TrMeaning::automatic && material.tr == 1.0F;
	return inverted ? 1.0F : by_tr;
}

} // namespace nook
