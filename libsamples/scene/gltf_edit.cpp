// SPDX-License-Identifier: GPL-3.0-or-later
// This work is based on: Khronos Group, "glTF 2.0 Specification", ISO/IEC 12113:2022, sections 3.6, 3.7 and 4.4.
#include "scene/gltf_edit.h"

#include "core/base64.h"
#include "core/content_hash.h"
#include "core/decimal.h"
#include "core/error.h"
#include "core/file.h"
#include "core/json_text.h"
#include "core/lists.h"
#include "core/system.h"
#include "core/words.h"

#include <glm/common.hpp>

#include <algorithm>
#include <array>
#include <cassert>
#include <filesystem>
#include <limits>
#include <tuple>
#include <utility>

namespace nook
{
namespace
{

using Document = GltfEditor::Document;

constexpr const char* kRecord = "nook"; // in asset.extras

// Removes a field, and its holder if that becomes empty.
void eraseIn(Document& item, const char* holder, const char* field)
{
	const auto found = item.find(holder);
	if (found != item.end() && found->is_object() && found->erase(field) > 0 && found->empty())
	{
		item.erase(holder);
	}
}

// glTF has no empty lists: they are what items() made, or what is left of extensions.
void dropEmpty(Document& json)
{
	for (auto at = json.begin(); at != json.end();)
	{
		at = at->is_array() && at->empty() && at.key() != "extras" ? json.erase(at) : std::next(at);
	}
}

// A hash of the document without the record of a bake. Order and white space do not count.
std::string stateOf(Document json)
{
	eraseIn(json["asset"], "extras", kRecord);
	ContentHash hash;
	hash.add(jsonLine(nlohmann::json(json)));
	return hash.text();
}

std::string dataUri(const std::string& bytes)
{
	return "data:application/octet-stream;base64," + base64Of({reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()});
}

} // namespace

// In a file that was changed since, the indices of its patch may mean other items: values are then replaced where they are found.
std::string undoBake(GltfFile& file)
{
	Document json = Document::parse(file.text);
	const Document extras = json.is_object() ? json.value("asset", Document::object()).value("extras", Document()) : Document();
	if (!extras.is_object() || !extras.contains(kRecord) || !extras[kRecord].is_object())
	{
		return {};
	}
	const Document& record = extras[kRecord];
	const bool is_same = textIn(record, "state") == stateOf(json);
	eraseIn(json["asset"], "extras", kRecord);
	try
	{
		json = is_same ? json.patch(record.value("undo", Document::array())) : std::move(json);
	}
	catch (const Document::exception&)
	{
		refuseInput(file.path + ": asset.extras.nook.undo", "no patch of this file", "what nook bake wrote");
	}
	file.text = jsonLine(json);
	file.json = nlohmann::json::parse(file.text); // anybody may have written the patch
	file.buffers.clear();
	file.decoded.clear();
	return is_same ? std::string() : textIn(record, "to");
}

std::size_t numberIn(const Document& item, const std::string& field, std::size_t otherwise)
{
	const auto found = item.find(field);
	return found != item.end() && found->is_number_unsigned() ? found->get<std::size_t>() : otherwise;
}

std::string textIn(const Document& item, const char* field)
{
	const auto found = item.find(field);
	return found != item.end() && found->is_string() ? found->get<std::string>() : "";
}

GltfEditor::GltfEditor(const GltfFile& of, const std::string& output) : file(of)
{
	const std::string ending = endingOf(output);
	m_to_binary = ending == ".glb" || (ending != ".gltf" && file.is_binary);
	assert(m_to_binary || !file.is_binary);
	checkGltf(file);
	json = Document::parse(of.text);
	failIf(!json["asset"].value("extras", Document::object()).is_object(), *this, "asset.extras", "no object", "one, or nothing",
		   ExitCode::unsupported);
	m_has_lines = file.text.find('\n') < file.text.size() - 1; // some programs end their one line
	earlier = undoBake(file);
	json = Document::parse(file.text);
	checkGltf(file);
	decompress();
	if (!compression.empty() || m_to_binary != file.is_binary)
	{
		gather();
	}
	dropEmpty(json);
	m_before = json;
	m_view_before = items("bufferViews").size();
}

void GltfEditor::fail(const std::string& where, const std::string& found, const std::string& expected, ExitCode code) const
{
	throw Error(code, file.path + ": " + where + ": found " + found + ", expected " + expected);
}

Document& GltfEditor::items(const char* name)
{
	Document& list = json[name];
	list = list.is_null() ? Document::array() : std::move(list);
	return list;
}

void GltfEditor::decompress()
{
	constexpr std::array<const char*, 2> kCompressions{"KHR_draco_mesh_compression", "EXT_meshopt_compression"};
	constexpr std::array<const char*, 2> kLists{"extensionsUsed", "extensionsRequired"};
	for (const char* const list : kLists)
	{
		Document& names = items(list);
		for (const char* const name : kCompressions)
		{
			const auto found = std::find(names.begin(), names.end(), name);
			if (found != names.end())
			{
				compression = name == kCompressions[0] || compression == "draco" ? "draco" : "meshopt";
				names.erase(found);
			}
		}
	}
	if (compression.empty())
	{
		return;
	}
	nlohmann::json made = file.json;
	for (const char* const list : kLists)
	{
		made[list] = json.value(list, Document::array());
	}
	json = json.patch(Document(nlohmann::json::diff(nlohmann::json(json), made))); // members keep their order
	for (Document& view : items("bufferViews"))
	{
		eraseIn(view, "extensions", kCompressions[1]);
	}
	for (Document& mesh : items("meshes"))
	{
		for (Document& primitive : mesh["primitives"])
		{
			eraseIn(primitive, "extensions", kCompressions[0]);
			setBounds(numberIn(primitive["attributes"], "POSITION"));
		}
	}
}

// Compression rounds positions, whose bounds an accessor states.
void GltfEditor::setBounds(std::size_t index)
{
	if (index == kNoNumber || items("accessors")[index]["componentType"] != 5126U)
	{
		return;
	}
	const GltfValues values(file, index);
	glm::dvec3 least(std::numeric_limits<double>::max());
	glm::dvec3 most = -least;
	for (std::size_t i = 0; i < values.count(); ++i)
	{
		least = glm::min(least, values.vec3(i));
		most = glm::max(most, values.vec3(i));
	}
	items("accessors")[index]["min"] = {least.x, least.y, least.z};
	items("accessors")[index]["max"] = {most.x, most.y, most.z};
}

// Puts all views into one buffer.
void GltfEditor::gather()
{
	std::map<std::tuple<std::size_t, std::size_t, std::size_t>, std::size_t> known;
	std::string gathered;
	for (std::size_t i = 0; i < items("bufferViews").size(); ++i)
	{
		Document& view = items("bufferViews")[i];
		const std::string_view bytes = viewBytes(file, i);
		padTo4(gathered);
		const auto [at, is_new] =
			known.try_emplace({numberIn(view, "buffer", 0), numberIn(view, "byteOffset", 0), bytes.size()}, gathered.size());
		gathered += is_new ? bytes : std::string_view();
		view["buffer"] = 0U;
		view["byteOffset"] = at->second;
	}
	Document buffer{{"byteLength", gathered.size()}};
	if (!m_to_binary)
	{
		buffer["uri"] = dataUri(gathered);
	}
	m_gathered = std::move(gathered);
	json["buffers"] = Document::array();
	json["buffers"].push_back(std::move(buffer));
}

std::size_t GltfEditor::addView(Document view, std::string_view bytes)
{
	items("bufferViews").push_back(std::move(view));
	m_added.emplace_back(bytes);
	return items("bufferViews").size() - 1;
}

std::size_t GltfEditor::addAccessor(const std::string& type, uint64_t component, std::size_t count, const std::string& bytes,
									bool is_indices)
{
	const std::size_t size = is_indices ? 0 : bytes.size() / count;
	const auto [known, is_new] = m_view_of_size.try_emplace(size, 0);
	if (is_new)
	{
		known->second = addView(is_indices ? Document{{"target", 34963U}} : Document{{"byteStride", size}, {"target", 34962U}}, {});
	}
	std::string& to = m_added[known->second - m_view_before];
	failIf(bytes.size() > kMaxFileBytes - std::min(kMaxFileBytes, to.size()), *this, "", "more than 1 GiB of values",
		   "less, as with --instances shared", ExitCode::unsupported);
	items("accessors")
		.push_back({{"bufferView", known->second},
					{"byteOffset", to.size()},
					{"componentType", component},
					{"count", count},
					{"type", type}});
	to += bytes;
	return items("accessors").size() - 1;
}

std::size_t GltfEditor::bytesAdded() const
{
	return m_settled_bytes + sumOver(m_added, [](const std::string& view) { return view.size(); });
}

// Appends the added views to the binary chunk if that is the first buffer, else to a buffer of their own.
void GltfEditor::placeViews()
{
	if (items("buffers").empty())
	{
		items("buffers").push_back({{"byteLength", 0U}});
	}
	const bool in_chunk = m_to_binary && !items("buffers")[0].contains("uri");
	std::string own;
	std::string& to = in_chunk ? chunk() : own;
	to.resize(in_chunk ? numberIn(items("buffers")[0], "byteLength") : 0);
	for (std::size_t i = 0; i < m_added.size(); ++i)
	{
		padTo4(to);
		Document view{
			{"buffer", in_chunk ? 0 : items("buffers").size()}, {"byteOffset", to.size()}, {"byteLength", m_added[i].size()}};
		view.update(items("bufferViews")[m_view_before + i]);
		items("bufferViews")[m_view_before + i] = std::move(view);
		to += m_added[i];
	}
	if (in_chunk && !m_added.empty())
	{
		padTo4(to);
		items("buffers")[0]["byteLength"] = to.size();
	}
	if (!own.empty())
	{
		items("buffers").push_back({{"byteLength", own.size()}, {"uri", dataUri(own)}});
	}
}

void GltfEditor::settle()
{
	m_settled_bytes = bytesAdded();
	placeViews();
	if (m_gathered)
	{
		file.chunk = std::move(*m_gathered);
		m_gathered.reset();
	}
	file.text = jsonLine(json);
	file.json = nlohmann::json::parse(file.text);
	file.is_binary = file.has_chunk = m_to_binary;
	file.buffers.clear();
	file.decoded.clear();
	m_added.clear();
	m_view_of_size.clear();
	m_view_before = items("bufferViews").size();
}

// Relative names of buffers and images, for an output in another folder.
void GltfEditor::rebase(const std::string& output)
{
	std::error_code failed;
	const auto folderOf = [&failed](const std::string& path)
	{
		const std::filesystem::path folder = nativePath(path).parent_path();
		return std::filesystem::weakly_canonical(folder.empty() ? "." : folder, failed);
	};
	const std::filesystem::path to = folderOf(output);
	for (const char* const list : {"buffers", "images"})
	{
		if (folderOf(file.path) == to || !json.contains(list))
		{
			continue;
		}
		for (Document& item : json[list])
		{
			const std::string uri = textIn(item, "uri");
			if (!uri.empty() && !uri.starts_with("data:") && uri.find("://") == std::string::npos)
			{
				const std::filesystem::path named = std::filesystem::weakly_canonical(
					std::filesystem::absolute(nativePath(besideLevel(file.path, unescaped(uri)))), failed);
				item["uri"] = escapedUri(std::filesystem::relative(named, to, failed).generic_string());
			}
		}
	}
}

std::string GltfEditor::take(const std::string& output, const Document& record)
{
	placeViews();
	dropEmpty(json);
	const Document undo = Document::diff(json, m_before);
	rebase(output);
	if (!record.is_null())
	{
		Document& made = json["asset"]["extras"][kRecord];
		made = record;
		made["state"] = stateOf(json);
		made["undo"] = undo;
	}
	return m_to_binary   ? glbContainer(jsonLine(json), chunk(), file.others, file.path)
		   : m_has_lines ? jsonFile(json)
						 : jsonLine(json) + "\n";
}

std::string& GltfEditor::chunk()
{
	return m_gathered ? *m_gathered : file.chunk;
}

Document bakeRecordOf(const std::string& path)
{
	const std::string ending = endingOf(path);
	if (path.starts_with("builtin:") || (ending != ".gltf" && ending != ".glb"))
	{
		return {};
	}
	Document record = Document::parse(openGltf(path).text);
	for (const char* const name : {"asset", "extras", kRecord})
	{
		record = record.is_object() ? record.value(name, Document()) : Document();
	}
	return record.is_object() ? record : Document();
}

std::string placeValues(std::span<const GltfPlace> places, std::span<const float> front, std::span<const float> back,
						const std::string& ending)
{
	const std::size_t sides = back.empty() ? 1 : 2;
	const bool is_csv = ending == ".csv";
	std::string rows = is_csv ? "node,instance,primitive,vertex,visibility" + std::string(sides == 2 ? ",back\n" : "\n") : "";
	Document parts = Document::array();
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
						 {"instance", place.instance ? Document(*place.instance) : Document()},
						 {"primitive", place.primitive},
						 {"values", std::move(values)}});
	}
	if (ending == ".json")
	{
		return jsonLine(Document{{"schema", "nook/vertices/1"}, {"sides", sides}, {"parts", std::move(parts)}}) + "\n";
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
