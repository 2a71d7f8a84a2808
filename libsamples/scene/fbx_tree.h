// SPDX-License-Identifier: GPL-3.0-or-later
// Parses an FBX file, binary or ASCII, into its tree of nodes. fbx_objects.h interprets them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace nook
{

// A value of a node. Arrays stay encoded until numbersOf() or wholesOf() reads them, since most are not needed.
struct FbxValue
{
	enum class Kind : uint8_t
	{
		whole,
		number,
		text, // a string, raw bytes, or an ASCII word such as T
		array,
	};
	Kind kind = Kind::whole;
	char type = 0;           // element type of an array: b, c, i, l, f or d; 0: ASCII text
	bool compressed = false; // with zlib
	uint64_t count = 0;      // stated number of elements
	union
	{
		int64_t whole = 0;
		double number;
	};
	std::string_view bytes; // in the file: the text, or the encoded array
};

struct FbxNode
{
	std::string_view name;
	std::vector<FbxValue> values;
	std::vector<FbxNode> children;

	const FbxNode* child(std::string_view name) const; // first child with that name, or null
};

class FbxFile
{
public:
	// Reads versions 7.1 to 7.7. Throws Error: file, invalid_input, unsupported for other versions.
	explicit FbxFile(std::string path);

	const std::string& path() const
	{
		return m_path;
	}
	const FbxNode& root() const
	{
		return m_root;
	}
	bool isText() const
	{
		return m_is_text;
	}

	// Value `index` of a node as text; empty if absent. ASCII escapes are resolved.
	std::string text(const FbxNode& node, std::size_t index) const;

	// The numbers of the node's array or, without one, of all its values. `where` locates the node in errors.
	std::vector<double> numbersOf(const FbxNode& node, const std::string& where) const;
	std::vector<int64_t> wholesOf(const FbxNode& node, const std::string& where) const;

	[[noreturn]] void fail(const std::string& where, const std::string& found, const std::string& expected) const;

private:
	template <class T> std::vector<T> arrayOf(const FbxNode& node, const std::string& where) const;
	template <class T> void decode(const FbxValue& value, const std::string& where, std::vector<T>& into) const;

	std::string m_path;
	std::string m_bytes;
	bool m_big_endian = false;
	bool m_is_text = false;
	FbxNode m_root;
};

// Value `index` of a node if it is a number.
std::optional<double> numberAt(const FbxNode& node, std::size_t index);
std::optional<int64_t> wholeAt(const FbxNode& node, std::size_t index);

} // namespace nook
