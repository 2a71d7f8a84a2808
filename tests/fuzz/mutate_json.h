// SPDX-License-Identifier: GPL-3.0-or-later
// Structure-aware mutators for JSON documents, and for binary glTF, whose JSON describes its bytes.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <random>
#include <string>

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

namespace nook::fuzz
{

using Chance = std::minstd_rand;

inline std::size_t below(Chance& chance, std::size_t bound)
{
	return bound == 0 ? 0 : chance() % bound;
}

// libFuzzer's generic byte mutation.
inline std::string mutatedBytes(std::string bytes, std::size_t most)
{
	const std::size_t size = bytes.size();
	bytes.resize(std::max(size, most));
	bytes.resize(LLVMFuzzerMutate(reinterpret_cast<std::uint8_t*>(bytes.data()), size, bytes.size()));
	return bytes;
}

inline std::size_t written(const std::string& bytes, std::uint8_t* data, std::size_t most)
{
	const std::size_t size = std::min(bytes.size(), most);
	std::memcpy(data, bytes.data(), size);
	return size;
}

inline std::uint32_t wordAt(const std::string& bytes, std::size_t at)
{
	std::uint32_t word = 0;
	std::memcpy(&word, bytes.data() + at, sizeof word);
	return word;
}

inline std::string wordBytes(std::uint32_t word)
{
	return {reinterpret_cast<const char*>(&word), sizeof word};
}

// The JSON document in a text, changed in one to four places; as bytes if it is not JSON, and sometimes anyway.
std::string mutatedJsonText(const std::string& text, std::size_t most, Chance& chance);

// A GLB with a changed document or changed binary data, with correct lengths except one time in sixteen.
std::string mutatedGlb(const std::string& glb, std::size_t most, Chance& chance);

} // namespace nook::fuzz

// The mutator of a target: libFuzzer calls it by this name.
#define NOOK_MUTATED_BY(mutated)                                                                                                   \
	extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed)          \
	{                                                                                                                              \
		nook::fuzz::Chance chance(seed);                                                                                           \
		return nook::fuzz::written(mutated(std::string(reinterpret_cast<const char*>(data), size), most, chance), data, most);     \
	}
