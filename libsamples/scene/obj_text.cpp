// SPDX-License-Identifier: GPL-3.0-or-later
// This work is based on: Wavefront Technologies, Advanced Visualizer manual, appendix B1, Object Files (.obj), and the MTL format
// beside it.
#include "scene/mesh_text.h"

#include <array>

namespace nook
{
namespace
{

using Words = std::vector<std::string_view>;

std::string joined(const Words& words, const std::vector<std::string>& rest)
{
	std::string line(words[0]);
	for (const std::string& word : rest)
	{
		line += " " + word;
	}
	return line;
}

// For v, vt and vn. A colour after a position is kept if it has three numbers and removed if it has four.
std::optional<std::string> repairedNumbers(Words& words, const TextPlace& place)
{
	bool changed = false;
	const auto comment = std::find_if(words.begin(), words.end(), [](std::string_view word) { return word.starts_with('#'); });
	if (comment != words.end())
	{
		words.erase(comment, words.end());
		changed = true;
	}
	std::vector<std::string> numbers;
	for (std::size_t i = 1; i < words.size(); ++i)
	{
		if (!isNumberText(words[i]))
		{
			place.fail(quoted(words[i]), "a number");
		}
		numbers.push_back(plainNumber(words[i]));
		changed = changed || numbers.back() != words[i];
	}
	const std::size_t count = numbers.size();
	if (words[0] == "v" && count != 3 && count != 4 && count != 6 && count != 7)
	{
		place.fail(std::to_string(count) + " numbers", "x y z, a weight behind them or a colour");
	}
	if ((words[0] == "vn" && count != 3) || (words[0] == "vt" && (count < 1 || count > 3)))
	{
		place.fail(std::to_string(count) + " numbers", words[0] == "vn" ? "x y z" : "u, u v or u v w");
	}
	if (count == 7 || (words[0] == "vt" && count == 1))
	{
		numbers.resize(words[0] == "v" ? 3 : 2, "0");
		changed = true;
	}
	return changed ? std::optional(joined(words, numbers)) : std::nullopt;
}

// "1", "1/2", "1//3" or "1/2/3", without signs and leading zeros.
std::string plainCorner(std::string_view word, const TextPlace& place)
{
	std::string plain;
	std::size_t parts = 0;
	for (std::size_t begin = 0; begin <= word.size(); ++parts)
	{
		const std::size_t end = std::min(word.find('/', begin), word.size());
		const std::string_view part = word.substr(begin, end - begin);
		const std::optional<int> index = wholeOf(part);
		if (parts > 2 || (!index && (parts == 0 || !part.empty())))
		{
			place.fail(quoted(word), "an index, or two or three with / between them");
		}
		plain += (parts > 0 ? "/" : "") + (index ? std::to_string(*index) : std::string());
		begin = end + 1;
	}
	return plain.substr(0, plain.find_last_not_of('/') + 1);
}

// For f, l and p.
std::optional<std::string> repairedCorners(const Words& words, const TextPlace& place)
{
	bool changed = false;
	std::vector<std::string> corners;
	for (std::size_t i = 1; i < words.size() && !words[i].starts_with('#'); ++i)
	{
		corners.push_back(plainCorner(words[i], place));
		changed = changed || corners.back() != words[i];
	}
	changed = changed || corners.size() + 1 < words.size();
	return changed ? std::optional(joined(words, corners)) : std::nullopt;
}

// Returns the text that replaces a line, or none to keep it.
std::optional<std::string> repairedObjLine(std::string_view line, Words& words, const TextPlace& place)
{
	constexpr std::array<std::string_view, 6> kOthers{"g", "o", "s", "usemtl", "mtllib", "mg"};
	const std::string_view keyword = words[0];
	std::optional<std::string> repaired;
	if (keyword == "v" || keyword == "vt" || keyword == "vn")
	{
		repaired = repairedNumbers(words, place);
	}
	else if (keyword == "usemtl" && line.size() > kMaxMaterialName)
	{
		return "usemtl " + (words.size() > 1 ? textFrom(words, 1).substr(0, kMaxMaterialName) : "");
	}
	else if (keyword == "f" || keyword == "l" || keyword == "p")
	{
		repaired = repairedCorners(words, place);
	}
	else if (std::find(kOthers.begin(), kOthers.end(), keyword) == kOthers.end())
	{
		return ""; // including curves and surfaces, which are not supported
	}
	const auto indent = static_cast<std::size_t>(keyword.data() - line.data());
	return repaired || indent == 0 ? repaired : std::optional(std::string(line.substr(indent)));
}

// Joins lines continued by a final \ into `made`; a single line is returned unchanged.
std::string_view onOneLine(std::string_view line, std::string& made)
{
	if (line.find_first_of("\r\n") == std::string_view::npos)
	{
		return line;
	}
	made = line;
	for (std::size_t at = made.find_first_of("\r\n"); at != std::string::npos; at = made.find_first_of("\r\n", at))
	{
		made[at] = ' ';
		made[at - 1] = made[at - 1] == '\\' ? ' ' : made[at - 1];
	}
	return made;
}

// x y z of a line's numbers, divided by the weight if there is one.
glm::dvec3 pointOf(const Words& words, const TextPlace& place)
{
	std::array<double, 4> numbers{0.0, 0.0, 0.0, 1.0};
	const bool has_weight = words.size() == 5;
	for (std::size_t i = 0; i < (has_weight ? 4 : 3); ++i)
	{
		numbers[i] = numberOf(words[i + 1]);
	}
	if (numbers[3] == 0.0)
	{
		place.fail("a weight of 0", "another");
	}
	return glm::dvec3(numbers[0], numbers[1], numbers[2]) / numbers[3];
}

// Replaces each position with its number, for exactPosition().
std::optional<std::string> numbered(const std::string& text, const std::string& path)
{
	uint32_t count = 0;
	const auto replaced = [&](std::string_view line, const TextPlace& /*place*/) -> std::optional<std::string>
	{
		if (line.size() < 2 || line[0] != 'v' || line[1] == 't' || line[1] == 'n')
		{
			return std::nullopt;
		}
		const uint32_t number = count++;
		return "v " + std::to_string(number & 0xffffU) + " " + std::to_string(number >> 16U) + " 0";
	};
	return repairedLines(text, path, true, replaced);
}

} // namespace

std::optional<std::string> repairedObj(const std::string& text, const std::string& path, std::vector<glm::dvec3>& exact)
{
	Words words;
	std::string one;
	ExactPositions positions;
	const auto repair = [&](std::string_view line, const TextPlace& place) -> std::optional<std::string>
	{
		line = onOneLine(line, one);
		splitWords(line, words);
		if (words.empty() || words[0].starts_with('#'))
		{
			return std::nullopt;
		}
		std::optional<std::string> repaired = repairedObjLine(line, words, place);
		if (words[0] == "v")
		{
			positions.add(pointOf(words, place));
		}
		return repaired;
	};
	std::optional<std::string> repaired = repairedLines(text, path, true, repair);
	exact = positions.take();
	return exact.empty() ? repaired : numbered(repaired ? *repaired : text, path);
}

glm::dvec3 exactPosition(const std::vector<glm::dvec3>& exact, glm::vec3 number)
{
	return exact.at(static_cast<std::size_t>(number.x) + (static_cast<std::size_t>(number.y) << 16U));
}

// This work is based on: Diane Ramey, Linda Rose, Lisa Tyerman, "MTL material format (Lightwave, OBJ)", Alias|Wavefront 1995.

namespace
{

// A line that references a picture: "map_d -s 2 2 1 -clamp on a leaf.png".
class PictureLine
{
public:
	PictureLine(const std::vector<std::string_view>& words, const TextPlace& place) : m_words(words), m_place(place) {}

	void read(MtlMaterial& material)
	{
		MaskSource mask;
		mask.channel = MaskChannel::alpha_or_first;
		material.ignored.clear();
		while (m_at < m_words.size() && m_words[m_at].starts_with('-'))
		{
			m_option = lowered(m_words[m_at++]);
			if (take(mask) && material.ignored.empty())
			{
				material.ignored = m_option;
			}
		}
		if (m_at >= m_words.size())
		{
			m_place.fail("nothing", "the name of a file behind " + std::string(m_words[0]));
		}
		mask.name = textFrom(m_words, m_at);
		material.mask = mask;
		// v grows upward in the file and downward in a level.
		material.uv_of_set = glm::dmat3(1.0);
		material.uv_of_set[0][0] = m_scale[0];
		material.uv_of_set[1][1] = m_scale[1];
		material.uv_of_set[2] = {m_offset[0], 1.0 - m_scale[1] - m_offset[1], 1.0};
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
		for (std::size_t i = 1; i < to.size() && m_at < m_words.size() && isNumberText(m_words[m_at]); ++i)
		{
			to[i] = number();
		}
		if (m_option == "-s" && (to[0] == 0.0 || to[1] == 0.0))
		{
			m_place.fail("a scale of 0", "another number behind -s");
		}
		return m_option == "-t" && (to[0] != 0.0 || to[1] != 0.0);
	}

	std::string_view word(const std::string& expected)
	{
		if (m_at >= m_words.size())
		{
			m_place.fail("nothing", expected + " behind " + m_option);
		}
		return m_words[m_at++];
	}

	double number()
	{
		const std::string_view text = word("a number");
		const double value = isNumberText(text) ? numberOf(text) : NAN;
		if (!(std::fabs(value) <= kMaxNumber))
		{
			m_place.fail(nook::quoted(text), "a number behind " + m_option);
		}
		return value;
	}

	bool isOn()
	{
		const std::string text = lowered(word("on or off"));
		if (text != "on" && text != "off")
		{
			m_place.fail(nook::quoted(text), "on or off behind " + m_option);
		}
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

float shareOf(const std::vector<std::string_view>& words, const TextPlace& place)
{
	const std::size_t at = words.size() > 1 && words[1] == "-halo" ? 2 : 1; // ignores how -halo depends on the view
	if (at >= words.size() || !isNumberText(words[at]))
	{
		place.fail(at < words.size() ? quoted(words[at]) : "nothing", "a number");
	}
	const double value = numberOf(words[at]);
	if (!(value >= 0.0 && value <= 1.0))
	{
		place.fail(quoted(words[at]), "0 to 1 behind " + std::string(words[0]));
	}
	return static_cast<float>(value);
}

// Only the name is needed here, so defects are not errors.
std::string colourOf(const std::vector<std::string_view>& words, const TextPlace& place)
{
	try
	{
		MtlMaterial material;
		PictureLine(words, place).read(material);
		return material.mask.name;
	}
	catch (const Error&)
	{
		return {};
	}
}

} // namespace

std::string readMtl(const std::string& text, const std::string& path, MtlMaterials& materials)
{
	MtlMaterial before; // for lines before the first name
	MtlMaterial* material = &before;
	std::vector<std::string_view> words;
	const auto take = [&](std::string_view line, const TextPlace& place) -> std::optional<std::string>
	{
		splitWords(line, words);
		const std::string keyword = words.empty() ? "" : lowered(words[0]);
		if (keyword == "newmtl")
		{
			const std::string name = words.size() > 1 ? textFrom(words, 1) : "DefaultMaterial"; // Assimp's default name
			const std::string cut = name.substr(0, kMaxMaterialName);
			material = &materials[cut];
			if (!material->name.empty() && material->name != name)
			{
				place.fail("a name that begins as another one",
						   "names that differ in their first " + std::to_string(kMaxMaterialName) + " bytes");
			}
			material->name = name;
			return "newmtl " + cut;
		}
		if (keyword == "d" || keyword == "tr")
		{
			(keyword == "d" ? material->d : material->tr) = shareOf(words, place);
		}
		else if (keyword == "map_d")
		{
			PictureLine(words, place).read(*material);
		}
		else if (keyword == "map_kd")
		{
			material->colour = colourOf(words, place);
		}
		return "";
	};
	return repairedLines(text, path, false, take).value_or("");
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
