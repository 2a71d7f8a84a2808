// SPDX-License-Identifier: GPL-3.0-or-later
// This work is based on: Diane Ramey, Linda Rose, Lisa Tyerman, "MTL material format (Lightwave, OBJ)", Alias|Wavefront 1995.
#include "scene/mtl_text.h"

#include "scene/number_text.h"
#include "scene/text_lines.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <vector>

namespace nook
{
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
