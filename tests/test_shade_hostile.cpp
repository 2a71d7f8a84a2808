// SPDX-License-Identifier: GPL-3.0-or-later
// Impossible inputs: depths and projections of any size. Every method rejects them, or returns visibility.
#include "hostile_views.h"
#include "small_views.h"
#include "testing.h"

namespace
{

struct RandomSource
{
	Random random;

	std::uint32_t below(std::size_t n)
	{
		return random.below(static_cast<std::uint32_t>(n));
	}
	float number()
	{
		return std::bit_cast<float>(random.below(0x7f800000U));
	}
};

std::vector<float> drawn(const GBuffer& gbuffer, ShadeMethod method)
{
	ShadeSettings settings;
	settings.method = method;
	return shadeOnCpu(gbuffer, hostileSamples(settings), settings, {1, {}}).visibility;
}

GBuffer cornell()
{
	static const GBuffer gbuffer = builtinView("cornell", 24, 18);
	return gbuffer;
}

} // namespace

TEST_CASE("hostile views: shading returns visibility or an error that says why", "[shade][hostile]")
{
	std::size_t taken = 0;
	std::size_t refused = 0;
	for (std::uint32_t i = 0; i < 20000; ++i)
	{
		RandomSource source{Random(7, i)};
		const HostileView view = hostileView(source);
		try
		{
			const Shaded shaded = shadeOnCpu(view.gbuffer, view.samples, view.settings, {1, {}});
			const std::size_t wrong = sumOver(shaded.visibility, [](const float value)
											  { return value >= 0.0F && value <= 1.0F ? std::size_t{0} : std::size_t{1}; });
			INFO("case " << i << ", " << nameOf(view.settings.method));
			REQUIRE(wrong == 0);
			taken += 1;
		}
		catch (const Error& error)
		{
			INFO("case " << i << ": " << error.what());
			REQUIRE(error.code() == ExitCode::invalid_input);
			refused += 1;
		}
	}
	CHECK(taken > 2000);
	CHECK(refused > 2000);
}

TEST_CASE("hostile views: the matrix of a projection may have any scale", "[shade][hostile]")
{
	for (std::size_t i = 0; i < namesOf<ShadeMethod>().size(); ++i)
	{
		const auto method = static_cast<ShadeMethod>(i);
		const std::vector<float> expected = drawn(cornell(), method);
		for (const double scale : {0x1p126, 0x1p-140, 4.0})
		{
			GBuffer scaled = cornell();
			scaled.view.projection = scaled.view.projection * scale;
			INFO(nameOf(method) << " at " << scale);
			CHECK(drawn(scaled, method) == expected);
		}
	}
}

TEST_CASE("hostile views: a depth that is no length is refused by its pixel", "[shade][hostile]")
{
	const float depth = GENERATE(1e-45F, 1.2e-38F, 1e-13F, 1e13F, 1e30F);
	GBuffer gbuffer = cornell();
	gbuffer.depth[24 * 3 + 5] = depth;
	for (std::size_t i = 0; i < namesOf<ShadeMethod>().size(); ++i)
	{
		CHECK(refusalBy([&] { drawn(gbuffer, static_cast<ShadeMethod>(i)); }).starts_with("depth, pixel 5,3: found "));
	}
}
