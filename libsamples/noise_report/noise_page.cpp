// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/json_text.h"
#include "core/text.h"
#include "noise_report/claims.h"
#include "noise_report/known.h"
#include "noise_report/measures.h"
#include "noise_report/page_text.h"
#include "page/assets.h"
#include "page/page_fill.h"

#include <nlohmann/json.hpp>

#include <cmath>

namespace nook
{
namespace
{

using Json = nlohmann::ordered_json;

// Seven significant digits are more than the grids are worth, and keep the page small.
double rounded(double value)
{
	return roundedNumber(value, 7);
}

double roundedCoordinate(double value)
{
	return std::floor(value * 1e4 + 0.5) / 1e4 + 0.0; // + 0.0: no −0
}

Json optionalNumber(const std::optional<double>& value)
{
	return value ? Json(rounded(*value)) : Json();
}

std::vector<const NoiseRow*> rowsOf(const std::vector<NoiseRow>& rows, const Series& series)
{
	std::vector<const NoiseRow*> found;
	for (const NoiseRow& row : rows)
	{
		if (series.holds(row))
		{
			found.push_back(&row);
		}
	}
	return found;
}

Json measuresJson(const std::vector<const NoiseRow*>& rows)
{
	Json measures = Json::object();
	for (const MeasureField& field : measureFields())
	{
		if (!field.get(rows.front()->quality))
		{
			continue; // this domain does not define it
		}
		Json& values = measures[std::string(field.name)] = Json::array();
		for (const NoiseRow* row : rows)
		{
			values.push_back(optionalNumber(field.get(row->quality)));
		}
	}
	return measures;
}

void addPoints(Json& series, const std::vector<const NoiseRow*>& rows)
{
	for (const char* name : {"points", "weights"})
	{
		series[name] = Json::array();
	}
	for (const NoiseRow* row : rows)
	{
		Json points = Json::array();
		Json weights = Json::array();
		for (std::size_t i = 0; i < row->pattern.count(); ++i)
		{
			const glm::dvec3& p = row->pattern.points[i];
			points.push_back(roundedCoordinate(p.x));
			points.push_back(roundedCoordinate(p.y));
			if (!isPlanar(row->pattern.domain))
			{
				points.push_back(roundedCoordinate(p.z));
			}
			weights.push_back(roundedNumber(row->pattern.weights[i], 4));
		}
		series["points"].push_back(points);
		series["weights"].push_back(weights);
	}
}

Json seriesJson(const std::vector<NoiseRow>& all, const Series& key, bool with_points)
{
	const std::vector<const NoiseRow*> rows = rowsOf(all, key);
	if (rows.empty())
	{
		return {};
	}
	Json series;
	series["domain"] = nameOf(key.domain);
	series["variant"] = nameOf(key.variant);
	series["method"] = nameOf(key.method);
	series["weights_rule"] = nameOf(key.weights);
	series["voronoi"] = nameOf(key.voronoi);
	for (const char* name : {"counts", "starts", "order", "antipodal", "rings"})
	{
		series[name] = Json::array();
	}
	for (const NoiseRow* row : rows)
	{
		series["counts"].push_back(row->recipe.count);
		series["starts"].push_back(row->recipe.starts);
		series["order"].push_back(row->symmetry.order);
		series["antipodal"].push_back(row->symmetry.antipodal);
		series["rings"].push_back(key.domain == Domain::sphere ? std::string() : ringText(row->symmetry));
	}
	series["measures"] = measuresJson(rows);
	if (with_points)
	{
		addPoints(series, rows);
	}
	return series;
}

Json allSeries(const std::vector<NoiseRow>& rows, WeightRule weights, VoronoiMode voronoi, bool with_points)
{
	Json list = Json::array();
	for (std::size_t d = 0; d < patternDomains().size(); ++d)
	{
		for (std::size_t v = 0; v < namesOf<Variant>().size(); ++v)
		{
			for (std::size_t m = 0; m < namesOf<Method>().size(); ++m)
			{
				const auto method = static_cast<Method>(m);
				const bool pictured = with_points && (method == Method::refine || method == Method::electro);
				Json series =
					seriesJson(rows, {static_cast<Domain>(d), static_cast<Variant>(v), method, weights, voronoi}, pictured);
				if (!series.is_null())
				{
					list.push_back(std::move(series));
				}
			}
		}
	}
	return list;
}

Json tablesJson(const std::vector<StudyTable>& tables)
{
	Json json = Json::array();
	for (const StudyTable& t : tables)
	{
		json.push_back({{"title", t.title}, {"head", t.head}, {"rows", t.rows}, {"note", t.note}});
	}
	return json;
}

Json claimJson(const Claim& claim)
{
	Json json{{"id", claim.id}, {"statement", claim.statement}, {"verdict", nameOf(claim.verdict)}};
	json["against"] = claim.against;
	json["explanation"] = claim.explanation;
	json["figures"] = Json::array();
	for (const ClaimFigure& f : claim.figures)
	{
		json["figures"].push_back({{"series", f.series},
								   {"subject", f.subject},
								   {"noise", rounded(f.noise)},
								   {"before", rounded(f.before)},
								   {"after", rounded(f.after)},
								   {"ratio", rounded(f.ratio)},
								   {"plane_ratio", rounded(f.plane_ratio)},
								   {"centre", rounded(f.centre)},
								   {"decides", f.decides},
								   {"verdict", nameOf(f.verdict)}});
	}
	json["pictures"] = Json::array();
	for (const ClaimPicture& p : claim.pictures)
	{
		json["pictures"].push_back(
			{{"domain", nameOf(p.domain)}, {"method", nameOf(p.method)}, {"variant", nameOf(p.variant)}, {"count", p.count}});
	}
	return json;
}

Json figuresJson(const NoiseReport& report, const std::string& command, const std::string& version, bool with_points)
{
	Json json;
	json["schema"] = "nook.report.noise/1";
	json["command"] = command;
	json["version"] = version;
	const NoiseReportSettings& s = report.settings;
	json["settings"] = {{"max_count", s.max_count}, {"starts", s.starts}, {"random_seeds", s.random_seeds}, {"seed", s.seed}};
	json["series"] = allSeries(report.rows, WeightRule::voronoi, VoronoiMode::exact, with_points);
	json["paper_series"] = allSeries(report.paper_rows, WeightRule::equal, VoronoiMode::exact, false);
	for (Json& series : allSeries(report.paper_rows, WeightRule::equal, VoronoiMode::discrete, false))
	{
		json["paper_series"].push_back(std::move(series));
	}
	json["fits"] = Json::array();
	for (const NoiseFit& fit : report.fits)
	{
		json["fits"].push_back({{"domain", nameOf(fit.domain)},
								{"measure", fit.measure},
								{"factor", rounded(fit.factor)},
								{"exponent", rounded(fit.exponent)}});
	}
	json["claims"] = Json::array();
	for (const Claim& claim : report.claims)
	{
		json["claims"].push_back(claimJson(claim));
	}
	json["studies"] = tablesJson(report.studies);
	json["filters"] = tablesJson(report.filters);
	json["known"] = Json::array();
	for (const KnownValue& k : compareKnownValues(report))
	{
		json["known"].push_back({{"pattern", k.pattern},
								 {"domain", nameOf(k.domain)},
								 {"measure", k.measure},
								 {"count", k.count},
								 {"value", k.value},
								 {"ours", rounded(k.ours)},
								 {"by", k.by}});
	}
	return json;
}

} // namespace

std::string noiseReportJson(const NoiseReport& report, const std::string& command, const std::string& version)
{
	return jsonFile(figuresJson(report, command, version, false));
}

std::string noiseReportHtml(const NoiseReport& report, const std::string& command, const std::string& version)
{
	Json data = figuresJson(report, command, version, true);
	data["lead"] = leadText(report);
	data["rule"] = verdictRules();
	data["why"] = whyText(report);
	data["reading"] = readingText(report, command, version);
	const int most = report.settings.max_count;
	for (const auto& [name, wanted] :
		 {std::pair{"selected", std::vector<int>{3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 19, 24, 32, 33, 48, 64}},
		  std::pair{"compared", std::vector<int>{4, 8, 9, 16, 32, 64}}})
	{
		data[name] = Json::array();
		for (const int count : wanted)
		{
			if (count <= most)
			{
				data[name].push_back(count);
			}
		}
	}
	return pageHtml({"noise against sample count",
					 version,
					 assets::page_html,
					 {},
					 {assets::charts_js, assets::pictures_js, assets::page_js},
					 jsonLine(data)});
}

} // namespace nook
