# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: gpu_script_test.sh PROGRAM SOURCE. scripts/gpu.sh: its bundle runs in an empty folder with an empty environment, every method
# agrees with the CPU and has times; no OpenGL, a broken bundle and bad arguments are refused. And what nook report times refuses.
set -u
nook=$(realpath "$1")
script=$(realpath "$2/scripts/gpu.sh")
. "$(dirname "$0")/command_line.sh"

fails 1 'LEVEL is required' report times
fails 1 "--only: found 'vo-lin', expected the beginning of a candidate's name" report times builtin:cornell --only vo-lin
fails 1 "--radius-px: found '0'" report times builtin:cornell --radius-px 4 --radius-px 0
fails 1 "--size: found '9x'" report times builtin:cornell --size 9x
fails 1 "--repetitions: found '0'" report times builtin:cornell --repetitions 0
works "radius 4 px, 'statvo 2 cells-2': [0-9.e+]* ms per megapixel" report times builtin:cornell --only 'statvo 2' --size 16x9 --radius-px 4 --repetitions 1
works '"left_out": [1-9]' report times builtin:cornell --only statvo --size 64x36 --seconds 1e-9 --json -

# ends CODE PATTERN COMMAND...: in an empty environment.
ends()
{
	code=$1
	pattern=$2
	shift 2
	env -i PATH="$PATH" HOME="$HOME" "$@" >../stdout 2>../stderr
	status=$?
	[ $status -eq "$code" ] && grep -qE -e "$pattern" ../stdout ../stderr ||
		problem "$*: found exit code $status, '$(tail -n 3 ../stderr)', expected $code, '$pattern'"
}

# A shader that is wrong by a tenth, swapped in by Mesa.
mkdir kept_shaders
ends 0 '' env MESA_SHADER_DUMP_PATH=kept_shaders "$nook" report times builtin:cornell --only 'gtao 3' --size 64x36 --check --repetitions 1
if ls kept_shaders/*.glsl >/dev/null 2>&1; then
	sed -i 's/nook_out = \(nook.*\);/nook_out = 0.9 * \1;/' kept_shaders/*.glsl
	ends 7 "gtao 3.*found more than 0.2 % of pixels that differ from the CPU" env MESA_SHADER_READ_PATH=kept_shaders \
		"$nook" report times builtin:cornell --only 'gtao 3' --size 64x36 --check --repetitions 1
fi

ends 1 "found '', expected bundle" sh "$script"
ends 1 "found '--fast', expected --quick" sh "$script" run --fast .
ends 0 'kept.tar.gz: [0-9]+ bytes' sh "$script" bundle "$nook" kept.tar.gz builtin:cornell
tar -xzf kept.tar.gz
ends 0 '^\| gtao .* \| 1 \|$' sh nook_gpu/gpu.sh run --quick kept_out
head -n 1 kept_out/gpu.md | grep -q OpenGL || problem "gpu.md: found '$(head -n 1 kept_out/gpu.md)', expected the renderer's name"
for method in vo-line vo-point vo-area alchemy statvo slices crytek volumetric-ao hbao sao gtao bitmask; do
	grep "\"method\": \"$method\"" kept_out/gpu.json >rows
	grep -q '"width_px": 64, .*"cpu_share_above_1_255": 0.0 ' rows && grep -q '"width_px": 128, .*"ms_per_megapixel": [1-9]' rows ||
		problem "$method: found '$(head -n 1 rows)', expected the CPU's picture, and times"
done
for part in '"cpu_twin":' '"radius_px": 16.0,' '"what": "aov",' '"what": "aov-mask",' '"what": "statvo, quarter tables by compute",' '"schema": "nook.error-report/1"'; do
	grep -qF "$part" kept_out/gpu.json || problem "gpu.json: found no $part"
done
if command -v python3 >/dev/null; then
	ends 0 nook.gpu/1 python3 -m json.tool kept_out/gpu.json
fi

# Vulkan alone will do.
none="env __EGL_VENDOR_LIBRARY_FILENAMES=/nonexistent"
# shellcheck disable=SC2086
if [ -e nook_gpu/bin/nook_tests ] && grep -q '^| slices 1 x 2 | 48 | [0-9]' kept_out/gpu.md; then
	ends 0 '^\| slices 1 x 2 \| 48 \| [0-9]' $none sh nook_gpu/gpu.sh run --quick kept_out
	grep -q '"vulkan": \[{"method": "lines 3 x 3", "radius_px": 48, "ms_per_megapixel": [0-9]' kept_out/gpu.json || problem "gpu.json: found no times of Vulkan"
else
	echo "gpu_script_test.sh: no Vulkan device, nook_tests or glslangValidator: not tried with Vulkan alone"
fi
# shellcheck disable=SC2086
ends 5 '^nook: OpenGL: found no' $none VK_ICD_FILENAMES=/nonexistent VK_DRIVER_FILES=/nonexistent sh nook_gpu/gpu.sh run --quick kept_out
rm nook_gpu/bin/nook
ends 3 'nook_gpu: found no bin/nook' sh nook_gpu/gpu.sh run --quick kept_out
rm -rf nook_gpu rows
finish
