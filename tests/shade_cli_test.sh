# SPDX-License-Identifier: GPL-3.0-or-later
# nook shade on the command line: rectangles, guard bands, limits of the radius, device depth; and its errors.
# usage: shade_cli_test.sh PROGRAM
set -u
nook=$1
. "$(dirname "$0")/command_line.sh"

works '' gbuffer builtin:courtyard --size 64x36 -o kept_g.exr
works '' pattern --domain disk --count 5 --starts 1 -o kept_disk.json
works '' tile --pattern kept_disk.json --size 2 --kind random -o kept_tile.json

# A guard band is shaded and cropped; a rectangle acts as a picture of its own.
works '' shade kept_g.exr --method vo-line --filter none --pattern kept_disk.json -o kept_whole.exr
works '' shade kept_g.exr --method vo-line --filter none --pattern kept_disk.json --guard 8 -o kept_inner.exr
works '48 x 20' info kept_inner.exr
works '' shade kept_g.exr --method vo-line --filter none --pattern kept_disk.json --guard 0 -o v.exr
works '^max +0 ' compare v.exr kept_whole.exr --max-error 0
works '' shade kept_g.exr --viewport 0,0,64,36 --method vo-line --filter none --pattern kept_disk.json -o v.exr
works '^max +0 ' compare v.exr kept_whole.exr --max-error 0
works '' shade kept_g.exr --viewport 16,8,32,20 --method vo-line -o v.exr
works '32 x 20' info v.exr
works '' reference builtin:courtyard --gbuffer kept_g.exr --viewport 16,8,32,20 --radius 1 --rays 16 -o v.exr
works '32 x 20' info v.exr
there v.exr
fails 3 'kept_g.exr: found 64 x 36 pixels, expected all of the rectangle among them \(--viewport\)' shade kept_g.exr --viewport 40,0,32,20 --method vo-line -o v.exr
fails 3 'kept_g.exr: found 64 x 36 pixels, expected more than --guard 18' shade kept_g.exr --guard 18 --method vo-line -o v.exr
for rectangle in 1,2,3 1,2,3,0 -1,0,3,3 1,2,3,4,5 1,2,3,x ''; do
	fails 1 '--viewport: found' shade kept_g.exr --viewport="$rectangle" --method vo-line -o v.exr
done
fails 1 '--guard: found .-1.' shade kept_g.exr --guard=-1 --method vo-line -o v.exr

# Frames of a tile: each gives another picture, and the cycle repeats.
works '' pattern --domain disk --count 4 --method vogel -o kept_four.json
works '' tile --pattern kept_four.json --size 2 --filter none --frames 3 --starts 1 -o kept_frames.json
for frame in 0 1 3; do
	works '' shade kept_g.exr --method vo-line --pattern kept_frames.json --filter none --frame $frame -o kept_frame$frame.exr
done
works '' shade kept_g.exr --method vo-line --pattern kept_frames.json --filter none -o kept_first.exr
cmp -s kept_frame0.exr kept_frame1.exr && problem "--frame 1: found the picture of frame 0, expected another"
works '^max +0 ' compare kept_frame0.exr kept_frame3.exr --max-error 0
works '^max +0 ' compare kept_frame0.exr kept_first.exr --max-error 0
fails 1 '--frame: found without a tile' shade kept_g.exr --method vo-line --frame 1 -o a.exr
fails 1 '--frame: found without a tile' shade kept_g.exr --method slices --frame 1 -o a.exr
fails 3 'kept_four.json: frames: found one, expected several for --frame' shade kept_g.exr --method vo-line --pattern kept_four.json --frame 1 -o a.exr
fails 1 "--frame: found '-1'" shade kept_g.exr --method vo-line --pattern kept_frames.json --frame -1 -o a.exr
works '' emit --methods vo-line --patterns kept_frames.json --glsl vulkan --main fragment -o a.glsl -o a.h -o a.js
if command -v glslangValidator >/dev/null; then
	glslangValidator -S frag -V a.glsl -o a.spv >../stdout 2>&1 || problem "a module of several frames: found '$(cat ../stdout)', expected SPIR-V"
	rm -f a.spv
fi
there a.glsl a.h a.js

# Radius limits in pixels are never applied silently.
works '"radius_limited_near": 0,' shade kept_g.exr --method vo-line -o v.exr --json -
works '"radius_limited_near": [1-9]' shade kept_g.exr --method vo-line --max-pixels 2 -o v.exr --json -
works '"radius_limited_far": [1-9]' shade kept_g.exr --method alchemy --min-pixels 4 -o v.exr --json -
there v.exr
fails 1 '--min-pixels: found .8., expected at most --max-pixels' shade kept_g.exr --method vo-line --max-pixels 4 --min-pixels 8 -o v.exr
fails 1 '--min-pixels: found 60000, expected at most' shade kept_g.exr --method vo-line --min-pixels 60000 -o v.exr
fails 1 '--max-pixels: found' shade kept_g.exr --method vo-line --max-pixels 0 -o v.exr
fails 1 '--normal-bits' shade kept_g.exr --method vo-line --normal-bits 8 -o v.exr
fails 1 '--normal-bits: found .7.' shade kept_g.exr --method alchemy --normal-bits 7 -o v.exr
works '' shade kept_g.exr --method alchemy --normal-bits 8 -o v.exr
there v.exr
for radius in 0 -1 nan inf x; do
	fails 1 '--radius: found' shade kept_g.exr --method vo-line --radius=$radius -o v.exr
done

# Channels, depths and projections. PFM has a single channel, Y, with rows from below.
projection='1 0 0 0 0 1 0 0 0 0 -1 -1 0 0 -0.2 0'
one='\000\000\200\077'
{ printf 'Pf\n2 2\n-1.0\n'; printf "$one$one\\000\\000\\300\\177$one"; } >kept_nan.pfm
{ printf 'Pf\n2 2\n-1.0\n'; printf "$one$one$one\\000\\000\\200\\277"; } >kept_negative.pfm
{ printf 'Pf\n2 2\n-1.0\n'; printf "$one\\000\\000\\200\\076$one$one"; } >kept_device.pfm
set -- --depth-channel Y --normals from-depth --world-to-camera identity --method vo-line -o v.exr
fails 3 'kept_nan.pfm: channel Y, pixel 0,0: found NaN, expected metres' shade kept_nan.pfm --projection "$projection" "$@"
fails 3 'kept_negative.pfm: channel Y, pixel 1,0: found -1, expected metres' shade kept_negative.pfm --projection "$projection" "$@"
fails 3 'kept_nan.pfm: channel Y, pixel 0,0: found NaN, expected device depth from 0 to 1' shade kept_nan.pfm --depth device --projection "$projection" "$@"
works '' shade kept_device.pfm --depth device --projection "$projection" "$@"
there v.exr
fails 3 'kept_device.pfm: .*singular' shade kept_device.pfm --projection '1 0 0 0 0 1 0 0 0 0 0 0 0 0 0 1' "$@"
fails 1 '--projection: found' shade kept_device.pfm --projection '1 0 0 0' "$@"
fails 1 '--projection: found' shade kept_device.pfm --projection '1 0 0 0 0 nan 0 0 0 0 -1 -1 0 0 -0.2 0' "$@"
fails 5 '--projection: found one with a skew' shade kept_device.pfm --projection '1 0 0 0 0.1 1 0 0 0 0 -1 -1 0 0 -0.2 0' "$@"
fails 3 'kept_device.pfm: projection: found none' shade kept_device.pfm "$@"
fails 3 'kept_whole.exr: .*(channel|normal)' shade kept_whole.exr --projection "$projection" --world-to-camera identity --method vo-line -o v.exr
fails 3 'kept_g.exr: .*(channel|depth)' shade kept_g.exr --depth-channel W --method vo-line -o v.exr
fails 3 'kept_device.pfm: .*normal' shade kept_device.pfm --depth-channel Y --projection "$projection" --world-to-camera identity --method vo-line -o v.exr

# Samples.
fails 3 'kept_tile.json: domain: found disk, expected hemisphere' shade kept_g.exr --method alchemy --pattern kept_tile.json -o v.exr
fails 1 '--filter: found .window. with kept_disk.json' shade kept_g.exr --method vo-line --filter window --pattern kept_disk.json -o v.exr

# Debug views instead of visibility.
for view in edges samples noise; do
	works "\"debug\": \"$view\"" shade kept_g.exr --method vo-line --pattern kept_tile.json --debug $view -o v.exr --json -
	works " $view " info v.exr
done
works '"debug": "lod"' shade kept_g.exr --method alchemy --depth-levels 3 --debug lod -o v.png --json -
works '"debug": "layers"' shade kept_g.exr --method statvo --layering uniform --layers 8 --debug layers -o v.exr --json -
works '"mean": 0\.' shade kept_g.exr --method sao --resolution half --debug noise -o v.exr --json -
there v.exr v.png
fails 1 '--debug: found lod with --method alchemy.*expected --method vo-area, sao' shade kept_g.exr --method alchemy --debug lod -o v.exr
fails 1 '--debug: found layers with --method hbao.*expected --method statvo' shade kept_g.exr --method hbao --debug layers -o v.exr
fails 1 '--debug: found noise with --method statvo' shade kept_g.exr --method statvo --debug noise -o v.exr
fails 1 '--debug: found noise with a pattern' shade kept_g.exr --method vo-line --pattern kept_disk.json --debug noise -o v.exr
fails 1 '--debug: found with --filter' shade kept_g.exr --method vo-line --debug edges --filter window -o v.exr
fails 1 '--debug: found with --taps' shade kept_g.exr --method vo-line --debug edges --taps 7 -o v.exr
fails 1 '--debug: found .all.' shade kept_g.exr --method vo-line --debug all -o v.exr
fails 1 '--depth-levels: found with' shade kept_g.exr --method vo-line --depth-levels 3 -o v.exr
fails 1 '--depth-levels: found .9.' shade kept_g.exr --method alchemy --depth-levels 9 -o v.exr

# Occlusion volumes, alone and with a screen-space method.
works '' volumes builtin:courtyard --distance 0.5 -o kept_v.glb
works '"volumes": [1-9]' shade kept_g.exr --method aov --volumes kept_v.glb -o kept_aov.exr --json -
works '"fragments": [1-9]' shade kept_g.exr --method aov-mask --directions 64 --volumes kept_v.glb -o kept_mask.exr --json -
works '"compensation": "none"' shade kept_g.exr --method aov --volumes kept_v.glb --no-compensation --resolution third -o v.exr --json -
works '"accumulate": "r8"' shade kept_g.exr --method aov --volumes kept_v.glb --device gl --accumulate r8 --draw-all -o v.exr --json -
works '' shade kept_g.exr --method vo-line --filter none --pattern kept_disk.json --volumes kept_v.glb -o kept_both.exr
works '"volumes": [1-9]' shade kept_g.exr --method vo-line --volumes kept_v.glb -o v.exr --json -
works '^max +0\.[0-9]*[1-9]' compare kept_both.exr kept_whole.exr
works '^max +0\.[0-9]*[1-9]' compare kept_both.exr kept_aov.exr
works '' shade kept_g.exr --method aov-mask --volumes kept_v.glb --threads 1 -o kept_one.exr
works '' shade kept_g.exr --method aov-mask --volumes kept_v.glb --threads 3 -o v.exr
works '^max +0 ' compare v.exr kept_one.exr --max-error 0
there v.exr
fails 1 '--volumes: found none with --method aov,' shade kept_g.exr --method aov -o v.exr
fails 2 'missing.glb' shade kept_g.exr --method aov --volumes missing.glb -o v.exr
fails 3 'kept_g.exr' shade kept_g.exr --method aov --volumes kept_g.exr -o v.exr
fails 1 '--radius: found with --method aov-mask, expected a screen-space' shade kept_g.exr --method aov-mask --volumes kept_v.glb --radius 1 -o v.exr
fails 1 '--filter: found with --method aov' shade kept_g.exr --method aov --volumes kept_v.glb --filter none -o v.exr
fails 1 '--directions: found with another method' shade kept_g.exr --method aov --volumes kept_v.glb --directions 64 -o v.exr
fails 1 '--directions: found .100., expected a multiple of 32' shade kept_g.exr --method aov-mask --volumes kept_v.glb --directions 100 -o v.exr
fails 1 '--resolution: found half with --method aov' shade kept_g.exr --method aov --volumes kept_v.glb --resolution half -o v.exr
fails 1 '--accumulate: found with --device cpu' shade kept_g.exr --method aov --volumes kept_v.glb --accumulate r8 -o v.exr
fails 1 '--no-compensation: found with --method aov-mask' shade kept_g.exr --method aov-mask --volumes kept_v.glb --no-compensation -o v.exr
fails 1 '--draw-all: found with no volumes' shade kept_g.exr --method vo-line --draw-all -o v.exr
fails 1 '--debug: found with --volumes' shade kept_g.exr --method vo-line --volumes kept_v.glb --debug edges -o v.exr
fails 1 '--debug: found with --method aov' shade kept_g.exr --method aov --volumes kept_v.glb --debug edges -o v.exr

# Bent normals, compared with the rays' and the plain ones.
works '' reference builtin:courtyard --gbuffer kept_g.exr --measure bent --falloff linear --radius 1 --rays 32 -o kept_rays.exr
works '"method": "slices"' shade kept_g.exr --method slices --radius 1 --bent -o kept_bent.exr -o kept_bent.png --json -
works 'bent[.]Z +-?[0-9.]+ to ' info kept_bent.exr
works 'cone_angle +[0-9.]+ to ' info kept_bent.exr
works '' shade kept_g.exr --method slices --radius 1 -o kept_v.exr
works '^max +0 ' compare kept_bent.exr kept_v.exr --max-error 0
works '' shade kept_g.exr --method slices --radius 1 --bent --guard 8 -o kept_inner.exr
works '48 x 20' info kept_inner.exr
works '^mean angle +[0-9.]+ degrees' compare kept_bent.exr kept_rays.exr --bent --mask kept_g.exr
works '"angles_deg": ' compare kept_g.exr kept_rays.exr --bent --json -
works '^max +0 degrees' compare kept_bent.exr kept_bent.exr --bent --max-error 0
"$nook" compare kept_g.exr kept_rays.exr --bent --max-error 0.5 >../stdout 2>../stderr
[ $? -eq 7 ] && grep -q '^nook: kept_g.exr: mean angle: found [0-9.]* degrees, expected at most 0.5$' ../stderr ||
	problem "compare --bent --max-error: found '$(cat ../stderr)'"
fails 3 'kept_v.exr: channels: found visibility, expected bent[.]X' compare kept_v.exr kept_rays.exr --bent
fails 3 'kept_inner.exr: size: found 48x20 pixels, expected 64x36' compare kept_inner.exr kept_rays.exr --bent
fails 1 '--metric: found with --bent' compare kept_bent.exr kept_rays.exr --bent --max-error 1 --metric mae
fails 1 '--bent: found with another method, expected --method slices' shade kept_g.exr --method vo-line --bent -o v.exr
fails 1 '--bent: found with --resolution' shade kept_g.exr --method slices --bent --resolution half -o v.exr
fails 1 '--bent: found with --filter window' shade kept_g.exr --method slices --bent --filter window -o v.exr
fails 1 '--bent: found with --debug' shade kept_g.exr --method slices --bent --debug edges -o v.exr
works '' emit --methods slices --bent --glsl vulkan --main fragment -o a.glsl -o a.h -o a.js
if command -v glslangValidator >/dev/null; then
	glslangValidator -S frag -V a.glsl -o a.spv >../stdout 2>&1 || problem "a module of bent normals: found '$(cat ../stdout)', expected SPIR-V"
	rm -f a.spv
fi
there a.glsl a.h a.js

# Without OpenGL it reports that, and does not fall back to the CPU.
export __EGL_VENDOR_LIBRARY_FILENAMES=/nonexistent
fails 5 'OpenGL: found no' shade kept_g.exr --method vo-line --device gl -o v.exr
unset __EGL_VENDOR_LIBRARY_FILENAMES
fails 5 'OpenGL: found no device 77' shade kept_g.exr --method vo-line --device gl --gl-device 77 -o v.exr
finish
