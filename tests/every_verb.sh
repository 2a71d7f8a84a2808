# SPDX-License-Identifier: GPL-3.0-or-later
# A short command line of every verb that writes, for robustness tests. Uses command_line.sh.

# makeInputs: makes their input files.
makeInputs()
{
	works '' gbuffer builtin:cornell --camera main --size 16x9 -o kept_g.exr
	works '' reference builtin:cornell --gbuffer kept_g.exr --radius 1 --rays 4 -o kept_r.exr
	works '' pattern --domain disk --count 3 --method vogel -o kept_p.json
	printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >kept.obj
}

# everyVerb: prints the command lines.
everyVerb()
{
	cat <<-EOT
		pattern --domain disk --count 3 --method vogel -o a.json -o a.svg
		tile --pattern kept_p.json --size 2 --kind even -o a.json -o a.exr
		catalogue --counts 1-2 --domain disk -o kept_patterns
		level kept.obj -o a.glb
		gbuffer builtin:cornell --camera main --size 16x9 -o a.exr
		reference builtin:cornell --gbuffer kept_g.exr --radius 1 --rays 4 -o a.exr -o a.png
		shade kept_g.exr --method vo-line -o a.exr -o a.png
		volumes builtin:cornell --distance 0.5 -o a.glb
		bake builtin:cornell --radius 0.5 --rays 4 -o a.glb
		bake builtin:cornell --radius 0.5 --rays 6 --probes 0.5 -o a.ktx2 -o a.glsl
		compare kept_r.exr kept_r.exr --diff a.png
		emit --methods vo-line --patterns kept_p.json --glsl 330 -o a.glsl -o a.h
		fit builtin:cornell --methods statvo --views 1 --size 16x9 --rays 4 -o a.json
		report noise --max-count 1 --starts 1 --seeds 1 -o a.html
		report error builtin:cornell --grid quick --methods statvo,alchemy,rays --size 16x9 --rays 4 --repetitions 1 --shifts 2 --pictures 1 --device cpu -o a.html
	EOT
}
