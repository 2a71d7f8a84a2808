// SPDX-License-Identifier: GPL-3.0-or-later
// Bytes that the depth reads of a method fetch into a GPU's first-level cache, per pixel.
// The model: 1280 x 720 pixels, drawn in blocks of 64 x 64, row by row; waves of 8 x 8 pixels, eight of which are in flight and
// take turns after each read; a cache of 16 KiB that drops the least recently used of its lines of 128 bytes, each a block of
// texels. usage: nook_caches <CASES     Each case on standard input is LAYOUT BITS COUNT, followed by the offsets in pixels, X Y,
// of COUNT reads for each of 16 variants. The variant of a pixel is its place in a window of 4 x 4. LAYOUT is plain; levels, where
// a read at distance d takes a level with log2(d) - 3.3 halvings; or deinterleaved, a layer per variant, drawn one after the other.
// Output: the bytes per pixel of each case, a line each.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <iostream>
#include <list>
#include <string>
#include <unordered_map>
#include <vector>

namespace
{
constexpr int kWidth = 1280;
constexpr int kHeight = 720;
constexpr int kBlock = 64; // pixels
constexpr int kWave = 8;
constexpr size_t kInFlight = 8;
constexpr size_t kLines = 16 * 1024 / 128;

struct Place
{
	int x, y;
};

class Cache
{
public:
	void read(uint64_t line)
	{
		if (const auto found = m_where.find(line); found != m_where.end())
		{
			m_lines.splice(m_lines.begin(), m_lines, found->second);
			return;
		}
		++misses;
		m_lines.push_front(line);
		m_where[line] = m_lines.begin();
		if (m_lines.size() > kLines)
		{
			m_where.erase(m_lines.back());
			m_lines.pop_back();
		}
	}
	int64_t misses = 0;

private:
	std::list<uint64_t> m_lines; // most recently used first
	std::unordered_map<uint64_t, std::list<uint64_t>::iterator> m_where;
};

double bytesPerPixel(const std::string& layout, int bits, const std::vector<std::vector<std::pair<double, double>>>& reads)
{
	const bool layered = layout == "deinterleaved";
	const int step = layered ? 4 : 1; // pixels between the texels of a layer
	const int width = kWidth / step;
	const int height = kHeight / step;
	const int line_height = 128 / (bits / 8) / 8; // lines are 8 texels wide
	std::vector<Place> waves;
	for (int y = 0; y < height; y += kBlock)
	{
		for (int x = 0; x < width; x += kBlock)
		{
			for (int i = 0; i < kBlock * kBlock / (kWave * kWave); ++i)
			{
				const Place wave = {x + i % (kBlock / kWave) * kWave, y + i / (kBlock / kWave) * kWave};
				if (wave.x < width && wave.y < height)
				{
					waves.push_back(wave);
				}
			}
		}
	}
	Cache cache;
	std::vector<uint64_t> lines;
	const auto readWave = [&](const Place& wave, size_t read, int layer)
	{
		lines.clear();
		for (int i = 0; i < kWave * kWave; ++i)
		{
			const int x = std::min(wave.x + i % kWave, width - 1) * step + layer % 4;
			const int y = std::min(wave.y + i / kWave, height - 1) * step + layer / 4;
			const auto& [right, down] = reads[static_cast<size_t>(4 * (y % 4) + x % 4)][read];
			const int there_x = std::clamp(static_cast<int>(std::floor(x + 0.5 + right)), 0, kWidth - 1);
			const int there_y = std::clamp(static_cast<int>(std::floor(y + 0.5 + down)), 0, kHeight - 1);
			const double distance = std::max(1.0, std::hypot(right, down));
			const int level = layout == "levels" ? std::max(0, static_cast<int>(std::floor(std::log2(distance) - 3.3))) : 0;
			const int picture = layered ? layer : level;
			const uint64_t line_x = static_cast<uint64_t>(((there_x / step) >> level) / 8);
			const uint64_t line_y = static_cast<uint64_t>(((there_y / step) >> level) / line_height);
			lines.push_back(static_cast<uint64_t>(picture) << 48 | line_y << 24 | line_x);
		}
		std::sort(lines.begin(), lines.end());
		lines.erase(std::unique(lines.begin(), lines.end()), lines.end());
		for (const uint64_t line : lines)
		{
			cache.read(line);
		}
	};
	for (int layer = 0; layer < (layered ? 16 : 1); ++layer)
	{
		for (size_t first = 0; first < waves.size(); first += kInFlight)
		{
			for (size_t read = 0; read < reads[0].size(); ++read)
			{
				for (size_t i = first; i < std::min(first + kInFlight, waves.size()); ++i)
				{
					readWave(waves[i], read, layer);
				}
			}
		}
	}
	return 128.0 * static_cast<double>(cache.misses) / (kWidth * kHeight);
}
} // namespace

int main()
{
	std::string layout;
	int bits = 0;
	size_t count = 0;
	while (std::cin >> layout >> bits >> count)
	{
		std::vector<std::vector<std::pair<double, double>>> reads(16, std::vector<std::pair<double, double>>(count));
		for (auto& variant : reads)
		{
			for (auto& [x, y] : variant)
			{
				std::cin >> x >> y;
			}
		}
		if (!std::cin || count == 0 || (bits != 16 && bits != 32) ||
			(layout != "plain" && layout != "levels" && layout != "deinterleaved"))
		{
			std::fprintf(stderr,
						 "nook_caches: standard input: found '%s', %d bits, %zu reads or too few offsets, expected LAYOUT BITS "
						 "COUNT and offsets\n",
						 layout.c_str(), bits, count);
			return 3;
		}
		std::printf("%.1f\n", bytesPerPixel(layout, bits, reads));
		std::fflush(stdout);
	}
	return 0;
}
