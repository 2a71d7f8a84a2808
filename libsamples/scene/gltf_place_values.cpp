// SPDX-License-Identifier: GPL-3.0-or-later
// Writes values per vertex as .csv, .npy or .json.
#include "core/decimal.h"
#include "core/json_text.h"
#include "scene/gltf_edit.h"

#include <utility>

namespace nook
{

std::string placeValues(std::span<const GltfPlace> places, std::span<const float> front, std::span<const float> back,
						const std::string& ending)
{
	const std::size_t sides = back.empty() ? 1 : 2;
	const bool is_csv = ending == ".csv";
	std::string rows = is_csv ? "node,instance,primitive,vertex,visibility" + std::string(sides == 2 ? ",back\n" : "\n") : "";
	GltfEditor::Document parts = GltfEditor::Document::array();
	for (const GltfPlace& place : places)
	{
		std::vector<float> values(place.count * sides, 0.0F);
		std::vector<float> times(place.count, 0.0F);
		for (const auto& [vertex, of_level] : place.vertices)
		{
			values[vertex * sides] += front[of_level];
			values[vertex * sides + sides - 1] += sides == 2 ? back[of_level] : 0.0F;
			times[vertex] += 1.0F;
		}
		for (std::size_t i = 0; i < values.size(); ++i)
		{
			values[i] = times[i / sides] > 0.0F ? values[i] / times[i / sides] : 1.0F;
		}
		const std::string instance = place.instance ? std::to_string(*place.instance) : "";
		const std::string head = std::to_string(place.node) + "," + instance + "," + std::to_string(place.primitive) + ",";
		for (std::size_t v = 0; is_csv && v < place.count; ++v)
		{
			rows += head + std::to_string(v) + "," + shortestDecimal(values[v * sides]) +
					(sides == 2 ? "," + shortestDecimal(values[v * sides + 1]) : "") + "\n";
		}
		if (ending == ".npy")
		{
			rows.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float));
		}
		parts.push_back({{"node", place.node},
						 {"instance", place.instance ? GltfEditor::Document(*place.instance) : GltfEditor::Document()},
						 {"primitive", place.primitive},
						 {"values", std::move(values)}});
	}
	if (ending == ".json")
	{
		return jsonLine(GltfEditor::Document{{"schema", "nook/vertices/1"}, {"sides", sides}, {"parts", std::move(parts)}}) + "\n";
	}
	if (is_csv)
	{
		return rows;
	}
	const std::string count = std::to_string(rows.size() / sizeof(float) / sides);
	std::string head = "{'descr': '<f4', 'fortran_order': False, 'shape': (" + count + (sides == 1 ? ",), }" : ", 2), }");
	head.resize((head.size() + 11 + 63) / 64 * 64 - 11, ' '); // numpy.lib.format, version 1.0: the values begin at a multiple of 64
	std::string bytes("\x93NUMPY\x01\x00", 8);
	appendRaw(bytes, static_cast<uint16_t>(head.size() + 1));
	return bytes + head + "\n" + rows;
}

} // namespace nook
