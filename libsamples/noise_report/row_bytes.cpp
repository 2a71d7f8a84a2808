// SPDX-License-Identifier: GPL-3.0-or-later
#include "noise_report/row_bytes.h"

#include "core/byte_text.h"

namespace nook
{
namespace
{

// Calls visit(value) for each number, or each that may be there.
template <class Visit> void forNumbers(Quality& q, Visit&& visit)
{
	for (const auto field : {&Quality::plane, &Quality::noise, &Quality::bias, &Quality::plane_exact, &Quality::greatest,
							 &Quality::spread, &Quality::smallest_distance, &Quality::energy, &Quality::energy_exponent})
	{
		visit(q.*field);
	}
}

template <class Visit> void forOptional(Quality& q, Visit&& visit)
{
	for (const auto field : {&Quality::cliff, &Quality::cliff_greatest, &Quality::centre, &Quality::crease, &Quality::cap})
	{
		visit(q.*field);
	}
}

} // namespace

std::string savedRow(const NoiseRow& row)
{
	ByteWriter out;
	Quality quality = row.quality;
	forNumbers(quality, [&](double value) { out.number(value); });
	forOptional(quality,
				[&](const std::optional<double>& value)
				{
					out.small(value ? 1 : 0);
					out.number(value.value_or(0.0));
				});
	out.small(static_cast<uint32_t>(row.symmetry.order));
	out.small(row.symmetry.mirrored ? 1 : 0);
	out.small(row.symmetry.antipodal ? 1 : 0);
	out.whole(row.symmetry.rings.size());
	for (const Ring& ring : row.symmetry.rings)
	{
		out.number(ring.radius);
		out.small(static_cast<uint32_t>(ring.samples));
		out.number(ring.weight);
	}
	out.whole(row.pattern.points.size());
	for (const glm::dvec3& point : row.pattern.points)
	{
		out.number(point.x);
		out.number(point.y);
		out.number(point.z);
	}
	for (const std::vector<double>* const list : {&row.pattern.weights, &row.pattern.powers})
	{
		out.whole(list->size());
		for (const double value : *list)
		{
			out.number(value);
		}
	}
	return out.take();
}

bool loadRow(std::string_view bytes, NoiseRow& row)
{
	ByteReader in(bytes);
	forNumbers(row.quality, [&](double& value) { value = in.number(); });
	forOptional(row.quality,
				[&](std::optional<double>& value)
				{
					const bool there = in.small() != 0;
					const double number = in.number();
					value = there ? std::optional(number) : std::nullopt;
				});
	row.symmetry.order = static_cast<int>(in.small());
	row.symmetry.mirrored = in.small() != 0;
	row.symmetry.antipodal = in.small() != 0;
	row.symmetry.rings.resize(in.count(20));
	for (Ring& ring : row.symmetry.rings)
	{
		ring.radius = in.number();
		ring.samples = static_cast<int>(in.small());
		ring.weight = in.number();
	}
	row.pattern.domain = row.recipe.domain;
	row.pattern.points.resize(in.count(24));
	for (glm::dvec3& point : row.pattern.points)
	{
		point.x = in.number();
		point.y = in.number();
		point.z = in.number();
	}
	for (std::vector<double>* const list : {&row.pattern.weights, &row.pattern.powers})
	{
		list->resize(in.count(8));
		for (double& value : *list)
		{
			value = in.number();
		}
	}
	const std::size_t count = row.pattern.points.size();
	return in.isAtEnd() && count == static_cast<std::size_t>(row.recipe.count) && row.pattern.weights.size() == count &&
		   (row.pattern.powers.empty() || row.pattern.powers.size() == count) && row.symmetry.order >= 1;
}

} // namespace nook
