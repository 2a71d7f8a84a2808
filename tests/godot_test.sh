# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: godot_test.sh PROGRAM SOURCE. Draws examples/godot with Godot 3 and compares the module's picture with that of nook shade for
# the depths that Godot drew: equal within 1/255 on 99.8 % of the pixels. The others lie around pixels where two neighbours fit the
# normal from depth equally well. Compiles the shaders of examples/godot4, which has never run. Exit code 77: no Godot 3, Xvfb, Python or
# oiiotool.
set -u
nook=$(realpath "$1")
source=$(realpath "$2")
. "$(dirname "$0")/table.sh"
. "$(dirname "$0")/steps.sh"
for tool in godot3 xvfb-run python3 idiff oiiotool; do
	command -v "$tool" >/dev/null ||
		{ echo "skipped: found no $tool, expected Debian's packages godot3 (scripts/setup.sh godot), xvfb, python3 and openimageio-tools"; exit 77; }
done
cp -r "$source/examples/godot" "$folder/the project" && cd "$folder/the project" || exit 1
cp -r "$source/examples/godot4" .
step "emit.sh" env "PATH=$(dirname "$nook"):$PATH" ./emit.sh || finish
# A scene that holds the example, and writes its pictures.
cat >save.gd <<'GD'
extends Spatial

func _ready():
	var main = load("res://main.tscn").instance()
	add_child(main)
	for i in 3:
		yield(VisualServer, "frame_post_draw")
	var sources = {"frame.png": get_viewport(), "depth.png": main.passes[0], "visibility.exr": main.passes[-1]}
	for name in sources:
		var image = sources[name].get_texture().get_data()
		image.flip_y()
		image.call("save_" + name.get_extension(), ProjectSettings.globalize_path("res://" + name))
	get_tree().quit()
GD
sed '/sub_resource/,$d; s/main/save/; s/load_steps=5/load_steps=2/' main.tscn >save.tscn
printf '[node name="save" type="Spatial"]\nscript = ExtResource( 1 )\n' >>save.tscn
step "draw" env "HOME=$folder" timeout 300 xvfb-run -a godot3 --path . --audio-driver Dummy save.tscn || finish
grep -E '(SHADER|SCRIPT) ERROR' "$folder/log" && problem "Godot: found complaints, expected none"
[ -z "${NOOK_KEEP:-}" ] || cp frame.png "$NOOK_KEEP"

# Depths from the three bytes, with the error bounds of the uniforms: depth_step * depth^2 + depth_share * depth.
near=0.1
far=200
step "steps" oiiotool depth.png --ch R,G,B --mulc 255 --mulc 65536,256,1 --chsum --divc 16777215 --mulc -1 --addc 1 -d float -o t.exr
step "depth" oiiotool t.exr --mulc "$(python3 -c "print(1 - $near / $far)")" --addc "$(python3 -c "print($near / $far)")" --powc -1 --mulc $near -d float -o z.exr
step "errors" oiiotool z.exr z.exr --mul --mulc "$(python3 -c "print((0.5 / 16777215 + 2 ** -25) * (1 / $near - 1 / $far))")" \
	z.exr --mulc "$(python3 -c 'print(6 * 2 ** -24)')" --add -d float -o error.exr
step "G-buffer" oiiotool z.exr error.exr --chappend --chnames Z,depth_error -o g.exr
step "visibility" oiiotool visibility.exr --ch G -o v.exr # Godot 3.2 reverses the names of the channels
projection=$(python3 -c "import math; y = 1 / math.tan(math.radians(31)); print(y * 360 / 640, 0, 0, 0, 0, y, 0, 0, 0, 0, -($far + $near) / ($far - $near), -1, 0, 0, -2 * $far * $near / ($far - $near), 0)")
# pictured WHAT OPTIONS…
pictured()
{
	what=$1
	shift
	step "$what: shade" "$nook" shade g.exr --sky-depth 199.9 --projection "$projection" --world-to-camera identity --normals from-depth \
		--method vo-line --pattern made/tile.json --filter window --radius 1.5 "$@" -o shade.exr
	idiff -fail 0.0039216 -failpercent 0.2 v.exr shade.exr >difference 2>&1
	[ $? -lt 2 ] || problem "$what: $(grep -E 'Max|pixels' difference)"
}
pictured "on the CPU"
grep 'over 0.0039' difference
pictured "in OpenGL" --device gl
# The window shows the level no brighter than its visibility, the same way up.
oiiotool frame.png --ch R v.exr --sub --printstats | awk '/Stats Max/ { exit !($3 < 0.003) }' || problem "frame.png: found pixels brighter than their visibility"
# Godot 4 has not been tried; its shaders compile.
step "Godot 4: emit.sh" env "PATH=$(dirname "$nook"):$PATH" ./godot4/emit.sh
for shader in godot4/made/pass0 godot4/made/pass1 godot4/product; do
	sed '1d' $shader.glsl >shader.comp
	command -v glslangValidator >/dev/null && step "Godot 4: $shader" glslangValidator -V shader.comp -o shader.spv
done
# Checks that the test itself can fail.
before=$failures
pictured "another radius" --max-pixels 8 >missed
[ $failures -gt $before ] && failures=$before || problem "another radius: found no difference, expected one"
finish
