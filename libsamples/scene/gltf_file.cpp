// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/gltf_file.h"

#include "core/base64.h"
#include "core/error.h"
#include "core/file.h"
#include "scene/load_parts.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace nook
{
namespace
{

constexpr uint32_t kGlbMagic = 0x46546C67;  // "glTF"
constexpr uint32_t kJsonChunk = 0x4E4F534A; // "JSON"
constexpr uint32_t kBinChunk = 0x004E4942;  // "BIN\0"

[[noreturn]] void refuseFile(const std::string& path, const std::string& what)
{
	throw Error(ExitCode::invalid_input, path + ": " + what);
}

uint32_t wordAt(const std::string& bytes, std::size_t at)
{
	uint32_t word = 0;
	for (std::size_t i = 0; i < 4; ++i)
	{
		word |= uint32_t{static_cast<unsigned char>(bytes[at + i])} << (8U * i);
	}
	return word;
}

// Splits a .glb into its chunks and returns the JSON text.
std::string takeChunks(std::string bytes, GltfFile& file)
{
	if (bytes.size() < 20 || wordAt(bytes, 0) != kGlbMagic)
	{
		refuseFile(file.path,
				   "header: found " + std::to_string(bytes.size()) + " bytes that are not a binary glTF, expected \"glTF\" first");
	}
	if (wordAt(bytes, 4) != 2)
	{
		refuseFile(file.path, "header: found version " + std::to_string(wordAt(bytes, 4)) + ", expected 2");
	}
	if (wordAt(bytes, 8) > bytes.size())
	{
		refuseFile(file.path,
				   "header: found " + std::to_string(bytes.size()) + " bytes, expected " + std::to_string(wordAt(bytes, 8)));
	}
	const std::size_t end = wordAt(bytes, 8);
	std::string json;
	std::size_t chunk_at = 0;
	std::size_t chunk_size = 0;
	std::size_t at = 12;
	for (int chunk = 0; at + 8 <= end; ++chunk)
	{
		const std::size_t size = wordAt(bytes, at);
		const uint32_t kind = wordAt(bytes, at + 4);
		at += 8;
		if (size > end - at)
		{
			refuseFile(file.path, "chunk " + std::to_string(chunk) + ": found " + std::to_string(end - at) + " bytes, expected " +
									  std::to_string(size));
		}
		if (chunk == 0 && kind != kJsonChunk)
		{
			refuseFile(file.path, "chunk 0: found another type, expected JSON");
		}
		if (chunk == 0)
		{
			json = bytes.substr(at, size);
		}
		else if (kind == kBinChunk && !file.has_chunk)
		{
			chunk_at = at;
			chunk_size = size;
			file.has_chunk = true;
		}
		at += size;
	}
	// In place, because it is most of a file that may be large.
	bytes.resize(chunk_at + chunk_size);
	bytes.erase(0, chunk_at);
	file.chunk = std::move(bytes);
	return json;
}

// Rejects JSON with so many values that parsing would take gigabytes ("{}," becomes 64 bytes), and text with a zero byte inside.
void checkText(const std::string& text, const std::string& path)
{
	constexpr std::size_t kMost = std::size_t{1} << 22U; // a level of 100 000 nodes has 2 million
	std::size_t values = 0;
	bool in_text = false;
	for (std::size_t i = 0; i < text.size(); ++i)
	{
		const char c = text[i];
		if (in_text)
		{
			if (text.compare(i, 6, "\\u0000") == 0)
			{
				refuseFile(path,
						   "JSON: found a character 0 at byte " + std::to_string(i) + ", expected text"); // names would end there
			}
			in_text = c != '"';
			i += c == '\\' ? 1 : 0;
			continue;
		}
		in_text = c == '"';
		values += c == ',' || c == '[' || c == '{' ? 1 : 0; // each starts at most one
	}
	if (values > kMost)
	{
		refuseFile(path, "JSON: found " + std::to_string(values) + " values, expected at most " + std::to_string(kMost));
	}
}

} // namespace

GltfFile openGltf(const std::string& path)
{
	GltfFile file;
	file.path = path;
	std::string text = readFile(path);
	const bool is_binary = endingOf(path) == ".glb";
	if (!is_binary && text.starts_with("glTF"))
	{
		refuseFile(path, "header: found a binary glTF, expected the ending .glb of one, or text");
	}
	if (is_binary)
	{
		text = takeChunks(std::move(text), file);
	}
	checkText(text, path);
	try
	{
		file.json = nlohmann::json::parse(text);
	}
	catch (const nlohmann::json::exception& error)
	{
		std::string reason = error.what();
		const std::size_t at = reason.find("at line");
		const std::size_t tag = reason.find("] "); // "[json.exception.out_of_range.406] "
		reason = at != std::string::npos    ? reason.substr(at)
				 : tag != std::string::npos ? "(" + reason.substr(tag + 2) + ")"
											: reason;
		refuseFile(path, "JSON: found an error " + reason.substr(0, reason.find(';')) + ", expected the text of a glTF file");
	}
	return file;
}

std::optional<std::string> dataOf(const std::string& uri, const JsonValue& item)
{
	if (!uri.starts_with("data:"))
	{
		return std::nullopt;
	}
	const std::size_t comma = uri.find(',');
	if (comma == std::string::npos || !std::string_view(uri).substr(0, comma).ends_with(";base64"))
	{
		item.fail("uri", "data that is not base64", "\"data:...;base64,...\"");
	}
	std::string text = uri.substr(comma + 1);
	text.append((4 - text.size() % 4) % 4, '='); // some writers omit the padding
	const std::optional<std::vector<uint8_t>> bytes = bytesOfBase64(text);
	if (!bytes)
	{
		const auto odd = std::find_if(uri.begin() + static_cast<std::ptrdiff_t>(comma) + 1, uri.end(),
									  [](char c) { return digitOfBase64(c) >= kBase64.size(); });
		item.fail("uri", "character " + std::to_string(odd - uri.begin()) + " that is not base64", "letters, digits, + and /");
	}
	return std::string(bytes->begin(), bytes->end());
}

std::string_view bufferBytes(GltfFile& file, std::size_t buffer, std::size_t offset, std::size_t length)
{
	const std::size_t count = file.root().count("buffers");
	const std::size_t first_decoded = count - file.decoded.size();
	if (buffer >= first_decoded)
	{
		return std::string_view(file.decoded[buffer - first_decoded]).substr(offset, length);
	}
	const JsonValue holder = file.root().item("buffers", buffer);
	if (!holder.has("uri"))
	{
		return std::string_view(file.chunk).substr(offset, length);
	}
	file.buffers.resize(first_decoded);
	std::optional<std::string>& bytes = file.buffers[buffer];
	if (!bytes)
	{
		const std::string uri = holder.text("uri");
		bytes = dataOf(uri, holder);
		bytes = bytes ? std::move(bytes) : readFile(besideLevel(file.path, unescaped(uri)));
	}
	if (bytes->size() < offset + length)
	{
		holder.fail("uri", std::to_string(bytes->size()) + " bytes", "what it had a moment ago");
	}
	return std::string_view(*bytes).substr(offset, length);
}

std::optional<JsonValue> extensionOf(const JsonValue& item, std::string_view name)
{
	const std::optional<JsonValue> extensions = item.object("extensions");
	return extensions ? extensions->object(name) : std::nullopt;
}

std::string_view viewBytes(GltfFile& file, std::size_t view)
{
	const JsonValue item = file.root().item("bufferViews", view);
	const auto index = static_cast<std::size_t>(item.wholeNeeded("buffer", UINT32_MAX));
	const auto offset = static_cast<std::size_t>(item.whole("byteOffset", UINT32_MAX).value_or(0));
	const auto length = static_cast<std::size_t>(item.wholeNeeded("byteLength", UINT32_MAX));
	return bufferBytes(file, index, offset, length);
}

} // namespace nook
