// SPDX-License-Identifier: GPL-3.0-or-later
// The squared error of a mean of variants is Σ_o s(o) Σ_v e(v, v + o) with e(v, v') = Σ w_i w'_j k(p_i, p'_j), where k is a smooth
// kernel (the centred sum of energy.cpp) and s the pair weight by the offset of two variants. Samples of different variants form
// very many pairs, for which only the smooth part of k matters. So between variants k(p, q) is approximated by m(p)ᵀ A m(q), where
// m holds all monomials up to a degree and A is a least-squares fit. A variant is then represented by its moments Σ w_i m(p_i), a
// filter acts on those, and averaged frames become independent of each other in the frequencies of the cycle. Within a variant k
// stays exact.
#include "pattern/tile_parts.h"

#include "core/lists.h"
#include "core/math.h"
#include "core/parallel.h"
#include "pattern/methods.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace nook
{
namespace
{

// Tuned on nine lines, 12 × 12 pixels, 8 frames, binomial:3: degree 12 has a tenth more error behind filter and mean.
constexpr int kPlanarDegree = 14;
constexpr int kSpatialDegree = 8;
constexpr int kNodes = 150;                 // in a quarter of the domain, at which the form stays below the kernel
constexpr double kRidge = 1e-10;            // added to the kernel's diagonal of 0.1; keeps it definite under rounding
constexpr std::size_t kVariantsAtOnce = 64; // variants processed per thread at a time

// Monomials sorted by parity: the kernel is invariant under mirroring an axis, so A is zero between different parities.
std::vector<std::array<int, 3>> exponentsIn(Domain domain)
{
	const int most = isPlanar(domain) ? kPlanarDegree : kSpatialDegree;
	std::vector<std::array<int, 3>> all;
	for (int parity = 0; parity < (isPlanar(domain) ? 4 : 8); ++parity)
	{
		for (int a = parity % 2; a <= most; a += 2)
		{
			for (int b = parity / 2 % 2; a + b <= most; b += 2)
			{
				for (int c = parity / 4; a + b + c <= most && (c == 0 || !isPlanar(domain)); c += 2)
				{
					all.push_back({a, b, c});
				}
			}
		}
	}
	return all;
}

// Range of the monomials of each parity.
std::vector<std::array<std::size_t, 2>> parities(const std::vector<std::array<int, 3>>& exponents)
{
	const auto parity = [&](std::size_t i)
	{
		return exponents[i][0] % 2 + exponents[i][1] % 2 * 2 + exponents[i][2] % 2 * 4;
	};
	std::vector<std::array<std::size_t, 2>> ranges(exponents.size());
	for (std::size_t i = 0; i < exponents.size(); ++i)
	{
		ranges[i][0] = i > 0 && parity(i) == parity(i - 1) ? ranges[i - 1][0] : i;
		for (std::size_t j = ranges[i][0]; j <= i; ++j)
		{
			ranges[j][1] = i + 1;
		}
	}
	return ranges;
}

// Points that cover the domain up to its rim, symmetric in every axis.
std::vector<glm::dvec3> mirroredNodes(Domain domain)
{
	Recipe recipe{.domain = domain, .count = kNodes};
	std::vector<glm::dvec3> nodes = isPlanar(domain) ? std::vector<glm::dvec3>{} : haltonPoints(Layout(recipe));
	for (int i = 0; i < kNodes && isPlanar(domain); ++i)
	{
		const double r = std::sqrt((i + 0.5) / kNodes); // uniform in area: descents seek out places where the form is too large
		const SinCos turn = sinCosOf(kPi * (3.0 - std::sqrt(5.0)) * i);
		nodes.push_back(placeInDomain(domain, {r * turn.cos, r * turn.sin, 0.0}));
	}
	for (int axis = 0; axis < (isPlanar(domain) ? 2 : 3); ++axis)
	{
		const std::size_t count = nodes.size();
		for (std::size_t i = 0; i < count; ++i)
		{
			nodes[i][axis] = std::fabs(nodes[i][axis]);
			nodes.push_back(nodes[i]);
			nodes.back()[axis] = -nodes[i][axis];
		}
	}
	return nodes;
}

inline std::size_t at(int exponent)
{
	return static_cast<std::size_t>(exponent);
}

// x⁰, x¹, … of each axis.
struct Powers
{
	std::array<std::array<double, kPlanarDegree + 1>, 3> of;
	std::array<std::array<double, kPlanarDegree + 1>, 3> by; // and their derivatives

	explicit Powers(const glm::dvec3& p)
	{
		for (std::size_t axis = 0; axis < 3; ++axis)
		{
			of[axis][0] = 1.0;
			by[axis][0] = 0.0;
			for (std::size_t n = 1; n <= kPlanarDegree; ++n)
			{
				by[axis][n] = static_cast<double>(n) * of[axis][n - 1];
				of[axis][n] = of[axis][n - 1] * p[static_cast<int>(axis)];
			}
		}
	}
};

// Value of a monomial in two or three of the coordinates.
template <int Axes> double valueOf(const Powers& p, const std::array<int, 3>& e)
{
	const double xy = p.of[0][at(e[0])] * p.of[1][at(e[1])];
	return Axes == 2 ? xy : xy * p.of[2][at(e[2])];
}

template <int Axes> glm::dvec3 slopeOf(const Powers& p, const std::array<int, 3>& e)
{
	const double x = p.of[0][at(e[0])];
	const double y = p.of[1][at(e[1])];
	const double z = Axes == 2 ? 1.0 : p.of[2][at(e[2])];
	return {p.by[0][at(e[0])] * y * z, x * p.by[1][at(e[1])] * z, Axes == 2 ? 0.0 : x * y * p.by[2][at(e[2])]};
}

struct Slope
{
	double value;
	glm::dvec3 by_point;
};

// Value and gradient of a polynomial.
template <int Axes> Slope sumOf(const Powers& powers, const std::vector<std::array<int, 3>>& exponents, const double* factors)
{
	Slope sum{0.0, glm::dvec3(0.0)};
	for (std::size_t a = 0; a < exponents.size(); ++a)
	{
		sum.value += factors[a] * valueOf<Axes>(powers, exponents[a]);
		sum.by_point += factors[a] * slopeOf<Axes>(powers, exponents[a]);
	}
	return sum;
}

// Solves L Lᵀ x = b for each column of b (rows × columns, row by row), L by Cholesky of the symmetric `a`.
void solve(std::vector<double> a, std::size_t n, std::vector<double>& b, std::size_t columns)
{
	for (std::size_t i = 0; i < n; ++i)
	{
		for (std::size_t j = 0; j <= i; ++j)
		{
			double sum = a[i * n + j];
			for (std::size_t k = 0; k < j; ++k)
			{
				sum -= a[i * n + k] * a[j * n + k];
			}
			a[i * n + j] = i == j ? std::sqrt(sum) : sum / a[j * n + j];
		}
	}
	const auto take = [&](std::size_t from, std::size_t to, double factor)
	{
		for (std::size_t c = 0; c < columns; ++c)
		{
			b[to * columns + c] -= factor * b[from * columns + c];
		}
	};
	const auto divide = [&](std::size_t row)
	{
		for (std::size_t c = 0; c < columns; ++c)
		{
			b[row * columns + c] /= a[row * n + row];
		}
	};
	for (std::size_t i = 0; i < n; ++i)
	{
		for (std::size_t k = 0; k < i; ++k)
		{
			take(k, i, a[i * n + k]);
		}
		divide(i);
	}
	for (std::size_t i = n; i-- > 0;)
	{
		for (std::size_t k = i + 1; k < n; ++k)
		{
			take(k, i, a[k * n + i]);
		}
		divide(i);
	}
}

std::vector<double> transposed(const std::vector<double>& a, std::size_t rows, std::size_t columns)
{
	std::vector<double> result(a.size());
	for (std::size_t i = 0; i < rows; ++i)
	{
		for (std::size_t j = 0; j < columns; ++j)
		{
			result[j * rows + i] = a[i * columns + j];
		}
	}
	return result;
}

// a (rows × inner) times b (inner × columns)
std::vector<double> product(const std::vector<double>& a, const std::vector<double>& b, std::size_t rows, std::size_t columns)
{
	const std::size_t inner = a.size() / rows;
	std::vector<double> result(rows * columns, 0.0);
	for (std::size_t i = 0; i < rows; ++i)
	{
		for (std::size_t k = 0; k < inner; ++k)
		{
			for (std::size_t j = 0; j < columns; ++j)
			{
				result[i * columns + j] += a[i * inner + k] * b[k * columns + j];
			}
		}
	}
	return result;
}

// to[i] += factor · from[i]
inline void addTo(double* to, const double* from, double factor, std::size_t count)
{
	for (std::size_t i = 0; i < count; ++i)
	{
		to[i] += factor * from[i];
	}
}

void forBlocks(std::size_t count, int threads, const std::function<void(std::size_t, std::size_t)>& body)
{
	parallelFor((count + kVariantsAtOnce - 1) / kVariantsAtOnce, threads,
				[&](std::size_t block) { body(block * kVariantsAtOnce, std::min(count, (block + 1) * kVariantsAtOnce)); });
}

} // namespace

std::size_t momentBytes(Domain domain, const TileShares& shares)
{
	return exponentsIn(domain).size() * sizeof(double) * (shares.frames > 1 ? 3 : 2);
}

std::size_t formBytes(Domain domain)
{
	const std::size_t nodes = kNodes * (isPlanar(domain) ? 4 : 8);
	return 3 * sizeof(double) * nodes * nodes; // pairs and the kernel; monomials take less
}

TileMoments::TileMoments(Domain domain, const TileShares& shares)
	: m_domain(domain), m_size(static_cast<std::size_t>(shares.size)), m_frames(static_cast<std::size_t>(shares.frames)),
	  m_own(shares.pairs[0]), m_exponents(exponentsIn(domain)), m_ranges(parities(m_exponents))
{
	makeForm();
	makeOffsets(shares);
	const std::size_t numbers = shares.pairs.size() * m_exponents.size();
	m_moments.resize(numbers);
	m_met.resize(numbers);
	m_spare.resize(m_even && m_frames > 1 ? numbers : 0);
}

// The greatest A for which P A Pᵀ stays below the kernel K at nodes that cover the domain, with P the monomials there: (Pᵀ K⁻¹
// P)⁻¹, by Schur's complement. The remainder of the kernel within each variant is then also an error. A plain least-squares fit
// leaves a remainder of either sign, which a descent exploits: 1.4 times the error.
void TileMoments::makeForm()
{
	const std::vector<glm::dvec3> nodes = mirroredNodes(m_domain);
	const QuadraticForm form = quadraticForm(m_domain, Ensemble::plane, nodes);
	const std::size_t count = m_exponents.size();
	std::vector<double> monomials;
	std::vector<double> kernel(nodes.size() * nodes.size());
	for (std::size_t i = 0; i < nodes.size(); ++i)
	{
		const Powers powers(nodes[i]);
		for (const Exponents& e : m_exponents)
		{
			monomials.push_back(m_domain == Domain::ball ? valueOf<3>(powers, e) : valueOf<2>(powers, e));
		}
		for (std::size_t j = 0; j < nodes.size(); ++j)
		{
			const double k = 0.5 * (form.linear[i] + form.linear[j] - form.pairs[i * nodes.size() + j]) + form.constant;
			kernel[i * nodes.size() + j] = k + (i == j ? kRidge : 0.0);
		}
	}
	std::vector<double> solved = monomials;
	solve(std::move(kernel), nodes.size(), solved, count);
	m_form.resize(count * count, 0.0);
	for (std::size_t a = 0; a < count; ++a)
	{
		m_form[a * count + a] = 1.0;
	}
	solve(product(transposed(monomials, nodes.size(), count), solved, count, count), count, m_form, count);
}

void TileMoments::makeOffsets(const TileShares& shares)
{
	const std::size_t area = m_size * m_size;
	for (std::size_t at = 0; at < area; ++at)
	{
		Offset offset{static_cast<int>(at % m_size), static_cast<int>(at / m_size), {}};
		bool any = false;
		for (std::size_t f = 0; f < m_frames; ++f)
		{
			offset.shares.push_back(shares.pairs[f * area + at]);
			any = any || offset.shares.back() != 0.0;
			// Equal up to rounding, since the sums were made in another order.
			const double back = shares.pairs[(m_frames - f) % m_frames * area + at];
			m_even = m_even && std::fabs(back - offset.shares.back()) <= 1e-12 * m_own;
		}
		if (any)
		{
			m_offsets.push_back(std::move(offset));
		}
	}
	if (!m_even || m_frames == 1)
	{
		return;
	}
	// Cosines and sines of the cycle: weights that are even in time act on each by a factor.
	const auto frames = static_cast<double>(m_frames);
	const std::vector<double> cosines =
		listOf(m_frames, [frames](std::size_t f) { return sinCosOf(2.0 * kPi * static_cast<double>(f) / frames).cos; });
	const auto frequencyOf = [](std::size_t wave)
	{
		return (wave + 1) / 2;
	};
	for (std::size_t wave = 0; wave < m_frames; ++wave)
	{
		const bool alone = wave == 0 || (wave + 1 == m_frames && m_frames % 2 == 0);
		for (std::size_t f = 0; f < m_frames; ++f)
		{
			const SinCos turn = sinCosOf(2.0 * kPi * static_cast<double>(frequencyOf(wave) * f % m_frames) / frames);
			m_waves.push_back(std::sqrt((alone ? 1.0 : 2.0) / frames) * (wave % 2 == 1 || alone ? turn.cos : turn.sin));
		}
	}
	for (Offset& offset : m_offsets)
	{
		std::vector<double> factors;
		for (std::size_t wave = 0; wave < m_frames; ++wave)
		{
			double sum = 0.0;
			for (std::size_t f = 0; f < m_frames; ++f)
			{
				sum += offset.shares[f] * cosines[frequencyOf(wave) * f % m_frames];
			}
			factors.push_back(sum);
		}
		offset.shares = std::move(factors);
	}
}

void TileMoments::findMoments(std::span<const glm::dvec3> points, std::span<const double> weights, int threads)
{
	const std::size_t variants = m_frames * m_size * m_size;
	const std::size_t samples = points.size() / variants;
	const std::size_t count = m_exponents.size();
	const bool spatial = m_domain == Domain::ball;
	forBlocks(variants, threads,
			  [&](std::size_t begin, std::size_t end)
			  {
				  for (std::size_t v = begin; v < end; ++v)
				  {
					  double* const moments = m_moments.data() + v * count;
					  std::fill(moments, moments + count, 0.0);
					  for (std::size_t i = v * samples; i < (v + 1) * samples; ++i)
					  {
						  const Powers powers(points[i]);
						  for (std::size_t a = 0; a < count; ++a)
						  {
							  moments[a] +=
								  weights[i] * (spatial ? valueOf<3>(powers, m_exponents[a]) : valueOf<2>(powers, m_exponents[a]));
						  }
					  }
				  }
			  });
}

// Frames → waves of the cycle, or back.
void TileMoments::turnInTime(const std::vector<double>& from, std::vector<double>& to, bool back, int threads) const
{
	const std::size_t area = m_size * m_size;
	const std::size_t count = m_exponents.size();
	forBlocks(area, threads,
			  [&](std::size_t begin, std::size_t end)
			  {
				  for (std::size_t i = 0; i < m_frames; ++i)
				  {
					  double* const sums = to.data() + (i * area + begin) * count;
					  std::fill(sums, sums + (end - begin) * count, 0.0);
					  for (std::size_t j = 0; j < m_frames; ++j)
					  {
						  addTo(sums, from.data() + (j * area + begin) * count, m_waves[back ? j * m_frames + i : i * m_frames + j],
								(end - begin) * count);
					  }
				  }
			  });
}

// Sums the variants at all offsets by their weights, for each frequency separately.
void TileMoments::meet(const std::vector<double>& from, std::vector<double>& to, int threads) const
{
	const std::size_t area = m_size * m_size;
	const std::size_t count = m_exponents.size();
	const bool waves = m_even && m_frames > 1;
	forBlocks(m_frames * area, threads,
			  [&](std::size_t begin, std::size_t end)
			  {
				  for (std::size_t v = begin; v < end; ++v)
				  {
					  double* const sums = to.data() + v * count;
					  std::fill(sums, sums + count, 0.0);
					  const std::size_t frame = v / area;
					  for (const Offset& offset : m_offsets)
					  {
						  const std::size_t x = (v % m_size + static_cast<std::size_t>(offset.dx)) % m_size;
						  const std::size_t y = (v / m_size % m_size + static_cast<std::size_t>(offset.dy)) % m_size;
						  for (std::size_t f = 0; f < (waves ? 1 : m_frames); ++f)
						  {
							  const std::size_t other = (frame + f) % m_frames * area + y * m_size + x;
							  addTo(sums, from.data() + other * count, offset.shares[waves ? frame : f], count);
						  }
					  }
				  }
			  });
}

// Returns the sum and adds its gradient by points and weights.
double TileMoments::pullBack(std::span<const glm::dvec3> points, std::span<const double> weights, EnergyGradient& gradient,
							 int threads)
{
	const std::size_t variants = m_frames * m_size * m_size;
	const std::size_t samples = points.size() / variants;
	const std::size_t count = m_exponents.size();
	std::vector<double> values(variants);
	gradient.points.resize(points.size());
	gradient.weights.resize(points.size());
	const double scale = 1.0 / static_cast<double>(variants);
	const auto of_variant = [&](std::size_t v, EnergyGradient& own)
	{
		const std::size_t first = v * samples;
		values[v] = m_own * squaredError(m_domain, Ensemble::plane, Part::whole, points.subspan(first, samples),
										 weights.subspan(first, samples), &own);
		// Error from all other variants, as a function of a sample.
		const double* const moments = m_moments.data() + v * count;
		double* const met = m_met.data() + v * count;
		addTo(met, moments, -m_own, count);
		std::array<double, 256> by_moment{};
		for (std::size_t a = 0; a < count; ++a)
		{
			const auto [begin, end] = m_ranges[a];
			addTo(by_moment.data() + begin, m_form.data() + a * count + begin, met[a], end - begin);
		}
		for (std::size_t a = 0; a < count; ++a)
		{
			values[v] += moments[a] * by_moment[a];
		}
		for (std::size_t i = 0; i < samples; ++i)
		{
			const Powers powers(points[first + i]);
			const auto [value, slope] = m_domain == Domain::ball ? sumOf<3>(powers, m_exponents, by_moment.data())
																 : sumOf<2>(powers, m_exponents, by_moment.data());
			gradient.points[first + i] = scale * (m_own * own.points[i] + 2.0 * weights[first + i] * slope);
			gradient.weights[first + i] = scale * (m_own * own.weights[i] + 2.0 * value);
		}
	};
	forBlocks(variants, threads,
			  [&](std::size_t begin, std::size_t end)
			  {
				  EnergyGradient own;
				  for (std::size_t v = begin; v < end; ++v)
				  {
					  of_variant(v, own);
				  }
			  });
	return scale * sumOver(values);
}

double TileMoments::operator()(std::span<const glm::dvec3> points, std::span<const double> weights, EnergyGradient& gradient,
							   int threads)
{
	assert(points.size() == weights.size() && points.size() % (m_frames * m_size * m_size) == 0);
	findMoments(points, weights, threads);
	if (m_even && m_frames > 1)
	{
		turnInTime(m_moments, m_met, false, threads);
		meet(m_met, m_spare, threads);
		turnInTime(m_spare, m_met, true, threads);
	}
	else
	{
		meet(m_moments, m_met, threads);
	}
	return pullBack(points, weights, gradient, threads);
}

} // namespace nook
