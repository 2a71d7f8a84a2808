// SPDX-License-Identifier: GPL-3.0-or-later
// The form factor's kernel against a slow and obvious twin of any precision, for polygons that are hard for 32 bits.
#include "testing.h"

#include "methods/volume_kernels.h"
#include "stress/hard_inputs.h"

#include <boost/multiprecision/cpp_bin_float.hpp>

using nook::stress::randomDirection;

namespace
{

namespace mp = boost::multiprecision;
using Big = mp::number<mp::cpp_bin_float<256, mp::digit_base_2>, mp::et_off>;

template <class T> using Vector = std::array<T, 3>;

template <class T> T dotOf(const Vector<T>& a, const Vector<T>& b)
{
	return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
template <class T> Vector<T> crossOf(const Vector<T>& a, const Vector<T>& b)
{
	return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// AOV's eq. 4 with the arc tangent, for the polygon clipped by the tangent plane (Sutherland and Hodgman); absolute.
template <class T, class Corner> T referenceFormFactor(const std::vector<Corner>& corners, const glm::vec3& normal)
{
	using std::atan2;
	using std::sqrt;
	const auto wide = [](const auto& v)
	{
		return Vector<T>{T(v.x), T(v.y), T(v.z)};
	};
	Vector<T> n = wide(normal);
	const T size = sqrt(dotOf(n, n));
	for (T& component : n)
	{
		component /= size;
	}
	std::vector<Vector<T>> kept;
	for (std::size_t i = 0; i < corners.size(); ++i)
	{
		const Vector<T> a = wide(corners[i]);
		const Vector<T> b = wide(corners[(i + 1) % corners.size()]);
		const T ha = dotOf(a, n);
		const T hb = dotOf(b, n);
		if (ha >= 0)
		{
			kept.push_back(a);
		}
		if ((ha > 0 && hb < 0) || (ha < 0 && hb > 0))
		{
			const T share = ha / (ha - hb);
			kept.push_back({a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1]), a[2] + share * (b[2] - a[2])});
		}
	}
	T sum = 0;
	for (std::size_t i = 0; i < kept.size(); ++i)
	{
		const Vector<T>& a = kept[i];
		const Vector<T>& b = kept[(i + 1) % kept.size()];
		const Vector<T> c = crossOf(a, b);
		const T length = sqrt(dotOf(c, c));
		if (length > 0)
		{
			sum += atan2(length, dotOf(a, b)) * dotOf(n, c) / length;
		}
	}
	const T pi = atan2(T(0), T(-1));
	return (sum < 0 ? -sum : sum) / (2 * pi);
}

// A convex polygon around its receiver, which is at the origin.
struct HardPolygon
{
	std::vector<glm::vec3> corners; // metres
	glm::vec3 normal{0, 0, 1};      // the receiver's
	float side = 1.0F;              // 1: the receiver is in front
};

// Kinds: 0 any; 1 needles as thin as 1e-7 of their length; 2 the receiver in line with an edge, or over a corner; 3 the receiver in
// the polygon's plane, or almost; 4 normals perpendicular to the polygon, or with corners in the tangent plane; 5 close to a large
// polygon.
constexpr int kHardKinds = 6;

double logUniform(Random& random, double least, double most)
{
	return least * std::pow(most / least, random.uniform());
}

// The receiver in the polygon's frame: x and y in its plane, z its height.
glm::dvec3 hardReceiver(Random& random, int kind, double size_m, const std::vector<glm::dvec2>& outline)
{
	const double far = size_m * logUniform(random, kind == 5 ? 1e-4 : 0.05, kind == 5 ? 0.1 : 100.0);
	glm::dvec3 at = far * randomDirection(random);
	at.z = std::fabs(at.z) + 1e-3 * far;
	if (kind == 0 || kind == 1)
	{
		at.z = std::max(at.z, 0.1 * far);
	}
	if (kind == 2)
	{
		const glm::dvec2 over = random.uniform() < 0.5 ? outline[0] : 2.5 * outline[0] - 1.5 * outline[1];
		at = glm::dvec3(over.x, over.y, far * 0.2);
	}
	if (kind == 3)
	{
		const double angle = 6.283185307179586 * random.uniform();
		const double out = 0.55 * size_m + far;
		at = glm::dvec3(out * std::cos(angle), out * std::sin(angle),
						random.uniform() < 0.3 ? 0.0 : out * logUniform(random, 1e-9, 1e-2));
	}
	if (kind == 5)
	{
		at = glm::dvec3(0.6 * (outline[0].x + outline[1].x), 0.6 * (outline[0].y + outline[1].y), far);
	}
	return at;
}

HardPolygon hardPolygon(Random& random, int kind)
{
	HardPolygon hard;
	const double size_m = logUniform(random, 1e-4, kind == 5 ? 1e4 : 100.0);
	const glm::dvec3 front = randomDirection(random);
	const glm::dvec3 u = glm::normalize(glm::cross(front, randomDirection(random)));
	const glm::dvec3 v = glm::cross(front, u);
	const double width = kind == 1 ? logUniform(random, 1e-7, 1.0) : 0.2 + 0.8 * random.uniform();
	const int count = 3 + static_cast<int>(random.uniform() * 6.0);
	std::vector<glm::dvec2> outline; // counter-clockwise about `front`
	const double first = 6.283185307179586 * random.uniform();
	for (int i = 0; i < count; ++i)
	{
		const double angle = first + 6.283185307179586 * (i + 0.8 * random.uniform()) / count;
		outline.push_back(0.5 * size_m * glm::dvec2(std::cos(angle), width * std::sin(angle)));
	}
	const glm::dvec3 at = hardReceiver(random, kind, size_m, outline);
	for (const glm::dvec2& p : outline)
	{
		hard.corners.push_back(glm::vec3(u * (p.x - at.x) + v * (p.y - at.y) - front * at.z));
	}
	hard.normal = glm::vec3(randomDirection(random));
	if (kind == 4)
	{
		const glm::dvec3 edge(hard.corners[0] - hard.corners[1]);
		const glm::dvec3 to(hard.corners[0]);
		hard.normal = glm::vec3(random.uniform() < 0.3   ? glm::normalize(glm::cross(front, edge))
								: random.uniform() < 0.5 ? glm::normalize(glm::cross(edge, to))
														 : glm::normalize(glm::cross(to, randomDirection(random))));
	}
	if (random.uniform() < 0.3)
	{
		std::reverse(hard.corners.begin(), hard.corners.end());
		hard.side = -1.0F;
	}
	return hard;
}

float formFactor(const std::vector<glm::vec3>& corners, glm::vec3 normal, float side)
{
	volume_kernels::Kernels kernels;
	kernels.corners = corners;
	return kernels.nookFormFactor(static_cast<int>(corners.size()), normal, side);
}

// The greatest error over `count` difficult polygons; `failed` counts results outside [0, 1].
template <class T> double greatestError(uint32_t count, int& failed)
{
	double greatest = 0.0;
	for (uint32_t i = 0; i < count; ++i)
	{
		Random random(7, i);
		const HardPolygon hard = hardPolygon(random, static_cast<int>(i % kHardKinds));
		const float found = formFactor(hard.corners, hard.normal, hard.side);
		failed += found >= 0.0F && found <= 1.0F ? 0 : 1;
		const auto expected = static_cast<double>(referenceFormFactor<T>(hard.corners, hard.normal));
		greatest = std::max(greatest, std::fabs(static_cast<double>(found) - expected));
	}
	return greatest;
}

// Between the references with a 64-bit mantissa and with 256 bits.
double greatestTwinDifference(uint32_t count)
{
	double greatest = 0.0;
	for (uint32_t i = 0; i < count; ++i)
	{
		Random random(7, i);
		const HardPolygon hard = hardPolygon(random, static_cast<int>(i % kHardKinds));
		const Big difference =
			Big(referenceFormFactor<long double>(hard.corners, hard.normal)) - referenceFormFactor<Big>(hard.corners, hard.normal);
		greatest = std::max(greatest, std::fabs(static_cast<double>(difference)));
	}
	return greatest;
}

} // namespace

TEST_CASE("form factor: a square one unit above is the known one", "[form_factor]")
{
	const std::vector<glm::vec3> square{{1, 1, 1}, {1, -1, 1}, {-1, -1, 1}, {-1, 1, 1}};
	CHECK(formFactor(square, {0, 0, 1}, 1.0F) == Approx(0.55412642).margin(2e-7));
	const std::vector<glm::vec3> behind(square.rbegin(), square.rend());
	CHECK(formFactor(behind, {0, 0, 1}, -1.0F) == Approx(0.55412642).margin(2e-7));
	CHECK(formFactor(behind, {0, 0, -1}, -1.0F) == 0.0F);
}

TEST_CASE("form factor: an endless slope covers (1 - cos a) / 2 up to its angle a", "[form_factor]")
{
	const double angle = GENERATE(0.2, 0.8, 1.3, 1.5707963);
	const glm::vec3 up(static_cast<float>(std::cos(angle)), 0.0F, static_cast<float>(std::sin(angle)));
	const glm::vec3 left(0.01F, -1e5F, 0);
	const glm::vec3 right(0.01F, 1e5F, 0);
	const float found = formFactor({right, left, left + 1e5F * up, right + 1e5F * up}, {0, 0, 1}, 1.0F);
	INFO("angle " << angle);
	CHECK(static_cast<double>(found) == Approx(0.5 * (1.0 - std::cos(angle))).margin(2e-6));
}

TEST_CASE("form factor: exact to 2e-6 against 256 bits, whatever the polygon", "[form_factor]")
{
	int failed = 0;
	const double error = greatestError<Big>(3000, failed);
	INFO("greatest error " << error);
	CHECK(error < 1e-6);
	CHECK(failed == 0);
}

// So the reference with a 64-bit mantissa, which takes a hundredth of the time, can check millions.
TEST_CASE("form factor: the twin of 64-bit mantissas is that of 256 bits, to far less than what is asked", "[form_factor]")
{
	const double apart = greatestTwinDifference(3000);
	INFO("twins differ by " << apart);
	CHECK(apart < 1e-9);
}

TEST_CASE("form factor: exact to 2e-6 for a hundred thousand hard polygons", "[form_factor]")
{
	int failed = 0;
	const double error = greatestError<long double>(100'000, failed);
	INFO("greatest error " << error);
	CHECK(error < 1e-6);
	CHECK(failed == 0);
}

// Takes two minutes; nook_tests "[form_factor_all]". Against 256 bits throughout it would be half an hour, for 1e-17 more.
TEST_CASE("form factor: exact to 2e-6 for ten million hard polygons", "[.][form_factor_all]")
{
	int failed = 0;
	const double error = greatestError<long double>(10'000'000, failed);
	const double apart = greatestTwinDifference(300'000);
	INFO("greatest error " << error << ", twins differ by " << apart);
	CHECK(error + apart < 2e-6);
	CHECK(failed == 0);
}

TEST_CASE("form factor: coordinates of 1e5 m lose nothing once corners are relative to the receiver", "[form_factor]")
{
	double greatest = 0.0;
	for (uint32_t i = 0; i < 3000; ++i)
	{
		Random random(8, i);
		const HardPolygon hard = hardPolygon(random, 0);
		const glm::dvec3 receiver = 1e5 * randomDirection(random);
		std::vector<glm::dvec3> exact;
		std::vector<glm::vec3> relative;
		for (const glm::vec3& corner : hard.corners)
		{
			const glm::dvec3 world = receiver + glm::dvec3(corner);
			exact.push_back(world - receiver); // world coordinates in 64 bits resolve 1.5e-11 m
			relative.emplace_back(world - receiver);
		}
		const double expected = referenceFormFactor<double>(exact, hard.normal);
		greatest = std::max(greatest, std::fabs(static_cast<double>(formFactor(relative, hard.normal, hard.side)) - expected));
	}
	INFO("greatest error " << greatest);
	CHECK(greatest < 2e-6);
}

TEST_CASE("form factor: a closed box around the receiver is the whole hemisphere", "[form_factor]")
{
	for (uint32_t i = 0; i < 300; ++i)
	{
		Random random(9, i);
		const glm::vec3 least(-static_cast<float>(logUniform(random, 1e-3, 1e3)),
							  -static_cast<float>(logUniform(random, 1e-3, 1e3)),
							  -static_cast<float>(logUniform(random, 1e-3, 1e3)));
		const glm::vec3 most = -least * static_cast<float>(logUniform(random, 0.1, 10.0));
		const glm::vec3 normal(randomDirection(random));
		double sum = 0.0;
		for (int axis = 0; axis < 3; ++axis)
		{
			for (const bool upper : {false, true})
			{
				// Counter-clockwise as seen from inside.
				std::vector<glm::vec3> face(4, upper ? most : least);
				const int u = (axis + 1) % 3;
				const int v = (axis + 2) % 3;
				for (std::size_t k = 0; k < 4; ++k)
				{
					const std::size_t turned = upper ? 3 - k : k;
					face[k][u] = turned == 1 || turned == 2 ? most[u] : least[u];
					face[k][v] = turned >= 2 ? most[v] : least[v];
				}
				sum += static_cast<double>(formFactor(face, normal, 1.0F));
			}
		}
		CHECK(sum == Approx(1.0).margin(1e-5));
	}
}

TEST_CASE("form factor: a share and no NaN where the receiver touches the polygon", "[form_factor]")
{
	const std::vector<glm::vec3> square{{1, 1, 0}, {1, -1, 0}, {-1, -1, 0}, {-1, 1, 0}};
	const std::array<glm::vec3, 6> places{glm::vec3(0), {1, 1, 0}, {1, 0, 0}, {0.3F, 0.2F, 0}, {1, 1, 1e-30F}, {1, 0, 1e-12F}};
	for (const glm::vec3& place : places)
	{
		const std::vector<glm::vec3> corners = mapped(square, [&](const glm::vec3& corner) { return corner - place; });
		for (uint32_t i = 0; i < 200; ++i)
		{
			Random random(10, i);
			const glm::vec3 normal = i == 0 ? glm::vec3(0, 0, 1) : i == 1 ? glm::vec3(1, 0, 0) : glm::vec3(randomDirection(random));
			const float found = formFactor(corners, normal, i % 2 == 0 ? 1.0F : -1.0F);
			CHECK((found >= 0.0F && found <= 1.0F));
		}
	}
	// No area at all.
	CHECK(formFactor({{1, 0, 0}, {1, 0, 0}, {1, 0, 0}}, {1, 0, 0}, 1.0F) == 0.0F);
	CHECK(formFactor({{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}, {1, 0, 0}, 1.0F) == 0.0F);
	CHECK(formFactor({{1, 0, 1}, {0, 0, 1}, {-1, 0, 1}}, {0, 0, 1}, 1.0F) == Approx(0.0).margin(1e-6));
}
