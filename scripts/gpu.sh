#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Measures the cost of the methods on a GPU, on a machine that has nothing but its driver (EGL, Vulkan or both), a shell and glibc 2.36 or
# newer. The bundle holds the program, its libraries, levels and their volumes, and for Vulkan nook_tests of the same build folder with
# glslangValidator, where both exist. Libraries of the machine count first, so that its driver finds its own.
# usage: gpu.sh bundle NOOK FILE.tar.gz [LEVEL...]   makes the bundle; levels default to the courtyard, the suburb and Sponza
#        gpu.sh run [--quick] FOLDER                 in the unpacked bundle: writes FOLDER/gpu.json, prints a table; --quick: tiny
set -eu

refuse()
{
	echo "gpu.sh: $2" >&2
	exit "$1"
}

loaders="libEGL.so.1 libOpenGL.so.0 libGLdispatch.so.0"

# libraries FILE...: paths of the libraries that they load, but for glibc's.
libraries()
{
	ldd "$@" | sed -n 's/^\t[^ ]* => \(\/[^ ]*\) .*/\1/p' | grep -v '/\(libc\|libm\|libdl\|libpthread\|librt\)\.so' | sort -u
}

bundle()
{
	nook=$(realpath "$1")
	file=$(realpath "$2")
	here=$(dirname "$(realpath "$0")")
	shift 2
	scratch=$(mktemp -d)
	trap 'rm -rf "$scratch"' EXIT
	if [ $# -eq 0 ]; then
		set -- builtin:courtyard builtin:suburb
		shared=$here/../../shared/scenes
		[ ! -e "$shared/sponza/sponza.glb.xz" ] || { sh "$shared/unpack.sh" "$scratch/scenes" >&2; set -- "$@" "$scratch/scenes/sponza/sponza.glb"; }
	fi
	out=$scratch/nook_gpu
	mkdir -p "$out/bin" "$out/lib/nook" "$out/libraries" "$out/levels"
	cp "$0" "$out/gpu.sh"
	cp "$nook" "$out/bin/nook"
	for worker in level picture; do
		cp "$(ls "$(dirname "$nook")"/../lib/nook/nook_${worker}_worker "$(dirname "$nook")"/../libsamples/core/nook_${worker}_worker 2>/dev/null)" "$out/lib/nook/"
	done
	tests=$(dirname "$nook")/../tests/nook_tests
	glslang=$(command -v glslangValidator || true)
	if [ -e "$tests" ] && [ -n "$glslang" ]; then
		strip -o "$out/bin/nook_tests" "$tests"
		cp -L "$glslang" "$out/bin/"
	fi
	libraries "$out"/bin/* "$out"/lib/nook/* | while read -r library; do cp -L "$library" "$out/libraries/"; done
	for library in $loaders; do # for machines that have a driver alone
		cp -L "$(/sbin/ldconfig -p | sed -n "s|^\t$library (libc6,.*) => ||p" | head -n 1)" "$out/libraries/"
	done
	for level in "$@"; do
		case $level in
		builtin:*) name=$level ;;
		*) name=levels/$(basename "$level"); cp "$level" "$out/levels/" ;;
		esac
		volumes=
		if [ $# -eq 1 ] || [ -e "$out/levels/list" ]; then # the first of several is for everything else
			volumes=levels/$(basename "${level#builtin:}").volumes.glb
			"$nook" volumes "$level" --distance 0.6 --ray-distance 1 --trim 0.15 --compensate --exact-bounds -o "$out/$volumes" >/dev/null
		fi
		echo "$name $volumes" >>"$out/levels/list"
	done
	tar -C "$scratch" -caf "$file" nook_gpu
	bytes=$(wc -c <"$file")
	[ "$bytes" -le $((64 << 20)) ] || refuse 4 "$file: found $bytes bytes, expected at most 64 MiB"
	echo "$file: $bytes bytes"
}

# Copies what the machine lacks, or has too old, to $use.
completeLibraries()
{
	while missing=$(for program in bin/* lib/nook/*; do LD_TRACE_LOADED_OBJECTS=1 "./$program" 2>&1 || true; done |
		sed -n 's/^\t\([^ ]*\) => not found$/\1/p; s/^.*\/\([^/:]*\): version .* not found.*$/\1/p' | sort -u) && [ -n "$missing" ]; do
		for library in $missing; do
			[ -e "libraries/$library" ] && [ ! -e "$use/$library" ] || refuse 5 "$library: found none that fits, expected glibc 2.36 or newer"
			cp "libraries/$library" "$use/"
		done
	done
}

# Draws a first picture, with the bundle's loaders where the machine has none. False without OpenGL, where Vulkan is all that there is.
findRenderer()
{
	until bin/nook report times builtin:cornell --only "statvo 2" --size 16x9 --repetitions 1 --json "$use/first.json" >/dev/null 2>"$use/why"; do
		status=$?
		if ! grep -q 'found no library' "$use/why" || [ -e "$use/libEGL.so.1" ]; then
			cat "$use/why" >&2
			[ -e bin/nook_tests ] || exit "$status"
			return 1
		fi
		for library in $loaders; do cp "libraries/$library" "$use/"; done
	done
}

# Modules for Vulkan and HLSL against the CPU, and times of compute shaders. False without a device.
vulkan()
{
	[ -e bin/nook_tests ] || return 1
	PATH="$PWD/bin:$PATH"
	if [ -z "$only" ]; then
		try "Vulkan against the CPU" timeout 60 bin/nook_tests "module: HLSL and Vulkan*" >"$use/vulkan.txt" || cat "$use/vulkan.txt" >&2
	fi
	timeout $((start + 500 - $(date +%s))) bin/nook_tests "[.times${only:+_quick}]" >"$use/vulkan.txt" 2>&1 || true
	sed -n '/| method/,/^[^|]/{ /^|/p; }' "$use/vulkan.txt" >"$use/vulkan.md"
	[ -s "$use/vulkan.md" ] || return 1
	sed -i "1i $(sed -n '/| method/{ x; p; }; h' "$use/vulkan.txt"), Vulkan\n" "$use/vulkan.md"
	sed -n 's/^| \(.*\) | \([0-9]*\) | \([0-9.e-]*\) | \([0-9.e-]*\) |.*/{"method": "\1", "radius_px": \2, "ms_per_megapixel": \3, "method_alone": \4}/p' "$use/vulkan.md" |
		sed '1s/^/[/; $!s/$/,/; $s/$/]/' >"$use/vulkan"
}

# left: seconds of the eight minutes, from which the last picture takes some more.
left()
{
	echo $((start + 420 - $(date +%s)))
}

# try NAME COMMAND...: goes on after a failure, with which this script ends.
try()
{
	name=$1
	shift
	echo "$name" >&2
	"$@" && return
	failed=$?
	echo "gpu.sh: $name: found exit code $failed, expected 0" >&2
	return "$failed"
}

# screen NAME ARGUMENTS of nook report times: its rows. Pictures that were compared with the CPU are too small to be timed.
screen()
{
	name=$1
	shift
	try "$name" bin/nook report times "$@" --json "$use/$name.json" >/dev/null || true
	sed -n 's/.*"candidate": "\([^"]*\)".*"cpu_share_above_1_255": \([^ ]*\) .*/\1|pixels above 1\/255 from the CPU, share|\2/p
		t
		s/.*"candidate": "\([^"]*\)".*"level": "\([^"]*\)", "width_px": \([0-9]*\), "height_px": \([0-9]*\), "radius_px": \([0-9]*\)[^,]*, "ms_per_megapixel": \([^,]*\),.*/\1|\2 \3x\4, radius \5 px|\6/p' "$use/$name.json" |
		sed 's/, radius 0 px//' >>"$use/rows"
}

# field FILE NAME: the first number with that name.
field()
{
	sed -n "s/.*\"$2\": *\([0-9.e+-]*\).*/\1/p" "$1" | head -n 1
}

# item WHAT LEVEL SIZE FIELD FILE.json: an item of $list.
item()
{
	{
		printf '%s{"what": "%s", "level": "%s", "size": "%s", "%s": ' "$comma" "$1" "${2##*/}" "$3" "$4"
		cat "$5"
		echo '}'
	} >>"$list"
	comma=,
}

# timed WHAT LEVEL SIZE OPTIONS of nook shade: one row, and an item.
timed()
{
	what=$1
	level=$2
	size=$3
	shift 3
	[ "$(left)" -gt 0 ] || { echo "$what, $level, $size: left out" >&2; return; }
	try "$what, $level, $size" drawn "$level" "$size" gl "$@" --timing --json "$use/v.json" >/dev/null || return 0
	item "$what" "$level" "$size" times "$use/v.json"
	echo "$what|${level##*/} $size|$(field "$use/v.json" milliseconds | awk -v size="$size" '{ split(size, s, "x"); print 1e6 * $1 / s[1] / s[2] }')" >>"$use/rows"
}

# drawn LEVEL SIZE DEVICE OPTIONS of nook shade: the picture $use/DEVICE.exr.
drawn()
{
	[ "$viewed" = "$1 $2" ] || bin/nook gbuffer "$1" --size "$2" -o "$use/g.exr" >/dev/null || return
	viewed="$1 $2"
	device=$3
	shift 3
	bin/nook shade "$use/g.exr" --device "$device" "$@" -o "$use/$device.exr"
}

# twins METHOD LEVEL VOLUMES: compares a small picture, since volumes are slow on a CPU, added up in 32 bits as there. At edges both
# round differently.
twins()
{
	exact=
	[ "$1" = aov-mask ] || exact="--accumulate r32f"
	# shellcheck disable=SC2086
	drawn "$2" "$least" cpu --method "$1" --volumes "$3" && drawn "$2" "$least" gl --method "$1" --volumes "$3" $exact || return
	status=0
	bin/nook compare "$use/gl.exr" "$use/cpu.exr" --metric p95 --max-error 0.00393 --json "$use/v.json" >/dev/null || status=$?
	[ $status -eq 0 ] || [ $status -eq 7 ] || return $status
	item "$1" "$2" "$least" cpu_twin "$use/v.json"
	return $status
}

volumes()
{
	while read -r level file; do
		[ -n "$file" ] || continue
		for method in aov aov-mask; do
			[ "$(left)" -le 0 ] || try "$method, $level against the CPU" twins $method "$level" "$file" || true
		done
		for size in $sizes; do
			for method in aov aov-mask; do
				timed $method "$level" "$size" --method $method --volumes "$file"
			done
		done
	done <levels/list
}

tables()
{
	for by in compute fragments; do
		for tables in full half quarter; do
			timed "statvo, $tables tables by $by" "$first" "$middle" --method statvo --tables $tables --tables-by $by
		done
	done
}

# One row per candidate, one column per picture, and the sum of the levels' pictures as a ratio.
table()
{
	awk -F '|' -v baseline='gtao 3 bilateral-5' '
		!($1 in seen) { seen[$1] = 1; name[++rows] = $1 }
		!($2 in place) { place[$2] = ++columns; head[columns] = $2 }
		!(($1, place[$2]) in value) || $3 > value[$1, place[$2]] { value[$1, place[$2]] = $3 } # shares: of the worst level
		END {
			printf "| ms per megapixel |"
			for (c = 1; c <= columns; ++c) printf " %s |", head[c]
			printf " × %s |\n| --- |", baseline
			for (c = 0; c <= columns; ++c) printf " --- |"
			print ""
			for (r = 1; r <= rows; ++r) {
				printf "| %s |", name[r]
				sum = unit = 0
				for (c = 1; c <= columns; ++c) {
					ours = value[name[r], c]; theirs = value[baseline, c]
					printf(ours == "" ? " - |" : " %.3g |", ours)
					if (ours != "" && theirs != "" && head[c] !~ /radius|share/) { sum += ours; unit += theirs }
				}
				printf(unit > 0 ? " %.3g |\n" : " - |\n", unit > 0 ? sum / unit : 0)
			}
		}' "$use/rows"
}

# part NAME FILE: a field of the result, null where the file is missing.
part()
{
	printf ',\n"%s": ' "$1"
	if [ -s "$use/$2" ]; then cat "$use/$2"; else echo null; fi
}

run()
{
	least=240x135 small=480x270 middle=1920x1080 sizes="1920x1080 3840x2160" radii="12 24 48 120 240" only='' swept="vo-line 3,vo-line 9 tile,alchemy 12 tile,slices,hbao,sao,gtao" report="--quick"
	if [ "$1" = --quick ]; then
		least=64x36 small=64x36 middle=128x72 sizes=128x72 radii="4 16" swept=gtao
		only="vo-line 3,vo-point 6 tile,vo-area 3,alchemy 4 tile,statvo 2,slices 1,crytek,volumetric-ao,hbao,sao,gtao,bitmask"
		report="--grid quick --methods gtao --size 64x36 --rays 16 --repetitions 1"
		shift
	fi
	mkdir -p "$1"
	out=$(realpath "$1")
	cd "$(dirname "$(realpath "$0")")"
	for file in bin/nook lib/nook/nook_level_worker libraries levels/list; do
		[ -e $file ] || refuse 3 "$PWD: found no $file, expected an unpacked bundle"
	done
	use=$(mktemp -d)
	trap 'rm -rf "$use"' EXIT
	start=$(date +%s) failed=0 viewed=
	export LD_LIBRARY_PATH="$use${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}:/usr/local/nvidia/lib64"
	# NVIDIA's driver in containers often comes without its entry in the list of vendors; entries without a library are skipped.
	echo '{"file_format_version": "1.0.0", "ICD": {"library_path": "libEGL_nvidia.so.0"}}' >"$use/nvidia.json"
	: "${__EGL_VENDOR_LIBRARY_FILENAMES:=$(ls "$use/nvidia.json" /usr/local/nvidia/share/glvnd/egl_vendor.d/*.json /etc/glvnd/egl_vendor.d/*.json /usr/share/glvnd/egl_vendor.d/*.json 2>/dev/null | tr '\n' ':')}"
	export __EGL_VENDOR_LIBRARY_FILENAMES
	completeLibraries
	opengl=no
	if findRenderer; then opengl=yes; opengl; fi
	vulkan || [ $opengl = yes ] || failed=5
	{
		printf '{\n"schema": "nook.gpu/1",\n"seconds": %d' $(($(date +%s) - start))
		part times times.json
		part radii radii.json
		part volumes volumes
		part tables tables
		part error error.json
		part vulkan vulkan
		echo '}'
	} >"$out/gpu.json"
	{
		[ ! -s "$use/rows" ] || { sed -n 's/.*"renderer": "\([^"]*\)".*/\1\n/p' "$use/first.json"; table; }
		[ ! -s "$use/vulkan.md" ] || { echo; cat "$use/vulkan.md"; }
	} | tee "$out/gpu.md"
	exit $failed
}

# Everything that OpenGL draws.
opengl()
{
	levels=$(cut -d ' ' -f 1 levels/list)
	first=$(echo "$levels" | head -n 1)
	options="--size $small"
	for size in $sizes; do options="$options --size $size"; done
	# shellcheck disable=SC2086 # one word each
	screen times $levels $options --check ${only:+--only "$only"} --seconds 190
	# shellcheck disable=SC2086,SC2046
	screen radii "$first" --size "$middle" --only "$swept" $(printf -- '--radius-px %s ' $radii) --seconds 60
	for list in "$use/volumes" "$use/tables"; do
		comma=[
		"${list##*/}"
		[ "$comma" = [ ] || echo ']' >>"$list"
	done
	# shellcheck disable=SC2086
	[ "$(left)" -le 0 ] || try "report error" timeout "$(left)" bin/nook report error "$first" $report --pictures 0 --json "$use/error.json" || true
}

case "${1:-} $#" in
bundle\ [3-9]*) shift; bundle "$@" ;;
"run 2") run "$2" ;;
"run 3") [ "$2" = --quick ] || refuse 1 "found '$2', expected --quick"; run "$2" "$3" ;;
*) refuse 1 "found '$*', expected bundle NOOK FILE.tar.gz [LEVEL...] or run [--quick] FOLDER" ;;
esac
