// SPDX-License-Identifier: MIT
// Bakes a level and writes it: bake LEVEL OUTPUT.glb
#include <nook/nook.hpp>

#include <cstdio>
#include <fstream>

int main(int argc, char** argv)
{
	if (argc != 3)
	{
		std::fprintf(stderr, "usage: bake LEVEL OUTPUT.glb\n");
		return NOOK_USAGE;
	}
	try
	{
		nook::check(nook_require(NOOK_ABI));
		const nook::Level level = nook::Level::load(argv[1]);
		const nook::Result baked = nook::bake(level, nook::Options().set("radius", 2.0).set("rays", 64).set("output", ".glb"));
		double sum = 0.0;
		const std::vector<float> visibility = baked.values<float>("visibility");
		for (const float value : visibility)
		{
			sum += static_cast<double>(value);
		}
		const std::string_view bytes = baked.file(".glb");
		std::ofstream(argv[2], std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
		std::printf("%zu vertices, mean visibility %.3f\n", visibility.size(), sum / static_cast<double>(visibility.size()));
		return 0;
	}
	catch (const nook::Failure& failure)
	{
		std::fprintf(stderr, "bake: %s\n", failure.what());
		return failure.status();
	}
}
