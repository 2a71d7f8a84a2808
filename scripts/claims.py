#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Holds the papers' claims against the figures of reports, and prints tables in Markdown (docs/measurements/claims.md).
# usage: claims.py REPORT.json...      of `nook report noise --json` or `nook report error --json`
# Claims about the radius take reports of one level with several --radius.
import json
import math
import sys

DIP, SLIGHT, LITTLE, ALIKE, UNLIKE = 0.95, 0.98, 1.02, 1.05, 1.15  # noise: shares of the trend, or of the other's error
FLAT = 0.08  # exponents up to which time does not grow: 12 % over four times the radius


def table(title, head, rows):
    if rows:
        print(f"\n{title}\n\n| {' | '.join(head)} |\n|{' --- |' * len(head)}")
        for row in rows:
            print(f"| {' | '.join(f'{cell:.3g}' if isinstance(cell, float) else str(cell) for cell in row)} |")


def exponent(curve):
    """Least squares in logarithms; None for fewer than three positive values."""
    logs = [(math.log(x), math.log(y)) for x, y in curve if x > 0 and y > 0]
    if len(logs) < 3 or len({x for x, _ in logs}) < 2:
        return None
    n, sx, sy = len(logs), sum(x for x, _ in logs), sum(y for _, y in logs)
    return (n * sum(x * y for x, y in logs) - sx * sy) / (n * sum(x * x for x, _ in logs) - sx * sx)


def between(curve, at):
    """y at x, along straight lines in logarithms between neighbours; None beyond them."""
    curve = sorted(point for point in curve if point[0] > 0 and point[1] > 0)
    for (x0, y0), (x1, y1) in zip(curve, curve[1:]):
        if x0 <= at <= x1 and x1 > x0:
            return math.exp(math.log(y0) + math.log(at / x0) / math.log(x1 / x0) * math.log(y1 / y0))
    return None


# ---- Volumetric Obscurance (Loos, Sloan 2010), §4.5 and figure 4: counts that are better than others.


def measure(report, domain, variant, method, name):
    for series in report["series"]:
        if (series["domain"], series["variant"], series["method"]) == (domain, variant, method):
            values = zip(series["counts"], series["measures"].get(name, []))
            return {count: value for count, value in values if value is not None and value > 2e-5}
    return {}


def to_trend(report, domain, name, values, count):
    """The value over the geometric mean of two neighbours a side, each carried to this count along N^-p."""
    power = next((fit["exponent"] for fit in report["fits"] if (fit["domain"], fit["measure"]) == (domain, name)), 0.0)
    logs = []
    for side in (-1, 1):
        near = [k for k in (count + side * step for step in range(1, 5)) if k in values][:2]
        if not near or count not in values:
            return None
        logs += [math.log(values[k]) + power * math.log(k / count) for k in near]
    return values[count] / math.exp(sum(logs) / len(logs))


def verdict(better, worse):
    return "mixed" if not better and not worse else "confirmed" if better else "refuted"


def claims_of_counts(report):
    counts = [("ball", "free", n) for n in (6, 12, 33)] + [("disk", "centred", n) for n in (5, 7, 9, 13, 16)]
    rows = []
    for domain, variant, n in counts + [("disk", "free", n) for n in (12, 13, 15)]:
        for method in ("electro", "refine"):
            noise, plane = (measure(report, domain, variant, method, name) for name in ("noise", "plane"))
            ratios = [to_trend(report, domain, "noise", noise, n), to_trend(report, domain, "plane", plane, n)]
            if None not in ratios:
                rows.append([f"{n}, {domain}, {variant}", method, noise[n], *ratios,
                             verdict(min(ratios) <= DIP and max(ratios) <= LITTLE, min(ratios) > SLIGHT)])
    table("Counts against their neighbours", ["count", "method", "noise", "noise to trend", "plane to trend", "better"], rows)
    rows = []
    pairs = [("disk", "free", 9, "disk", "free", 10), ("disk", "centred", 9, "disk", "centred", 10),
             ("disk", "centred", 9, "disk", "free", 10), ("ball", "free", 12, "ball", "free", 13),
             ("disk", "free", 5, "ball", "free", 12), ("disk", "centred", 5, "ball", "free", 12)]
    for one, one_variant, n, other, other_variant, m in pairs:
        for method in ("electro", "refine"):
            noise, plane = ((measure(report, one, one_variant, method, name), measure(report, other, other_variant, method, name))
                            for name in ("noise", "plane"))
            if n in noise[0] and m in noise[1]:
                ratio, of_plane = noise[0][n] / noise[1][m], plane[0][n] / plane[1][m]
                alike = one != other  # "look like", else "less noisy than"
                found = (verdict(max(ratio, of_plane) <= ALIKE, max(ratio, of_plane) > UNLIKE) if alike
                         else verdict(ratio <= DIP, ratio >= 1.0))
                rows.append([f"{n}, {one}, {one_variant}", f"{m}, {other}, {other_variant}", method, ratio, of_plane, found])
    table("Counts against others", ["count", "against", "method", "noise ratio", "plane ratio", "claim"], rows)


# ---- Time and error. Times are lower quartiles: whatever else a machine does only adds to them.


def low(point):
    return point["time"]["low_ms"]


def named(view, *names):
    return next((point for point in view["points"] if point["name"] in names), None)


def recipe(view, method):
    return [p for p in view["points"] if p["name"] == f"{method} {p['count']} electro window"]


def claims_of_view(name, view, rows):
    lines, points = recipe(view, "vo-line"), recipe(view, "vo-point")
    ratios = [(p["own_rmse"] / noise, p["eq14"] / error) for p in points
              for noise in [between([(low(q), q["own_rmse"] or 0.0) for q in lines], low(p))]
              for error in [between([(low(q), q["eq14"]) for q in lines], low(p))] if noise and error and p["own_rmse"]]
    if ratios:
        noise, error = (math.exp(sum(math.log(r[i]) for r in ratios) / len(ratios)) for i in (0, 1))
        rows["lines"].append([name, noise, error, "holds" if noise > 1.0 else "does not"])
    elif lines and points:
        rows["lines"].append([name, "–", "–", "no count of points takes as long as lines do"])
    five, twelve = named(view, "vo-line 5 electro window"), named(view, "vo-point 12 electro window")
    if five and twelve and five["own_rmse"] and twelve["own_rmse"]:
        ratio = five["own_rmse"] / twelve["own_rmse"]
        rows["five"].append([name, ratio, low(five) / low(twelve), "holds" if ratio <= UNLIKE else "does not"])
    volumes, built = named(view, "aov triangles"), named(view, "aov built")
    screen = [p for p in view["points"] if not p["method"].startswith(("aov", "bake", "rays"))]
    if volumes and built and screen:
        best = min(screen, key=lambda p: p["eq14"])
        rows["screen"].append([name, volumes["eq14"], built["eq14"], best["eq14"], best["name"],
                               "holds" if volumes["eq14"] < best["eq14"] else "does not"])
    rays = [p for p in view["points"] if p["origin"] == "rays"]
    if volumes and rays:
        count, time = (between([(p["eq14"], value(p)) for p in rays], volumes["eq14"]) for value in (lambda p: p["count"], low))
        most = max(p["count"] for p in rays)
        beyond = volumes["eq14"] < min(p["eq14"] for p in rays)
        holds = beyond and most >= 100 or (count or 0) >= 100 and time > low(volumes)
        rows["rays"].append([name, volumes["eq14"], count or (f"> {most}" if beyond else "< 1"),
                             time / low(volumes) if time else "–",
                             "out of reach" if beyond and most < 100 else "holds" if holds else "does not"])


def claims_of_radius(reports):
    curves = {}
    for report in reports:
        for level in report["levels"]:
            for view in level["views"]:
                for point in view["points"]:
                    if point["origin"] == "paper":
                        key = (level["name"], view["camera"], point["name"])
                        curves.setdefault(key, []).append((level["radius_m"], point))
    rows = []
    for (level, _, name), curve in curves.items():
        time, noise, fragments = (exponent([(r, value(p) or 0.0) for r, p in curve])
                                  for value in (low, lambda p: p["own_rmse"], lambda p: p["fragments"]))
        if time is not None:
            holds = (1.5 <= fragments <= 2.5 if fragments is not None else time <= FLAT if name.startswith("statvo")
                     else time > FLAT or (noise or 0.0) > FLAT)
            rows.append([level, name, time, *(value if value is not None else "–" for value in (noise, fragments)),
                         "holds" if holds else "does not"])
    table("Exponents of the radius. StatVO: time does not grow. AOV: fragments grow with the square. Others: time or noise grows",
          ["level", "candidate", "p of time", "p of noise", "p of fragments", ""], rows)


def claims_of_errors(reports):
    rows = {"lines": [], "five": [], "screen": [], "rays": []}
    for report in reports:
        for level in report["levels"]:
            for view in level["views"]:
                claims_of_view(f"{level['name']}, {view['camera']}, {level['radius_m']} m", view, rows)
    table("VO §5: lines beat points at equal time", ["view", "noise: points / lines", "eq. 14: points / lines", ""], rows["lines"])
    table("VO §5: five lines look like twelve points", ["view", "noise: 5 lines / 12 points", "time", ""], rows["five"])
    table("AOV §6: less error than every screen-space method", ["view", "AOV", "nook's volumes", "least", "which", ""], rows["screen"])
    table("AOV, figures 1 and 9: as good as hundreds of rays", ["view", "AOV's eq. 14", "rays of that error", "their time / AOV's", ""],
          rows["rays"])
    claims_of_radius(reports)


def main():
    if len(sys.argv) < 2:
        sys.exit("usage: claims.py REPORT.json...")
    errors = []
    for path in sys.argv[1:]:
        with open(path, encoding="utf-8") as file:
            report = json.load(file)
        if report["schema"] == "nook.report.noise/1":
            claims_of_counts(report)
        elif report["schema"] == "nook.error-report/1":
            errors.append(report)
        else:
            sys.exit(f"claims.py: {path}: schema: found {report['schema']}, expected nook.report.noise/1 or nook.error-report/1")
    claims_of_errors(errors)


main()
