// SPDX-License-Identifier: GPL-3.0-or-later
// WGSL from the GLSL of modules. webgpu_test.sh compares its pictures.
#include "testing.h"

#include "emit/module_parts.h"

namespace
{

// The translation of a function's body, without the function's own lines.
std::string bodyInWgsl(const std::string& body)
{
	const std::string wgsl = wgslOf("vec2 f(vec2 a, ivec2 i, float b, bool c)\n{\n" + body + "\n\treturn a;\n}\n");
	const std::string head = "{\n";
	const std::size_t at = wgsl.find(head) + head.size();
	return wgsl.substr(at, wgsl.rfind("\treturn a;\n") - at);
}

std::string refusedInWgsl(const std::string& glsl)
{
	try
	{
		return "translated: " + wgslOf(glsl);
	}
	catch (const Error& error)
	{
		CHECK(error.code() == ExitCode::unsupported);
		return error.what();
	}
}

} // namespace

TEST_CASE("wgsl: statements and operators of kernels", "[emit]")
{
	CHECK(bodyInWgsl("\t// why\n\tfloat from = b * 2.0f; // so") == "\t// why\n\tlet from_: f32 = b * 2.0f; // so\n");
	CHECK(bodyInWgsl("\tint n;\n\tn = i.x >> 1;") == "\tvar n: i32;\n\tn = i.x >> u32(1);\n");
	CHECK(bodyInWgsl("\tb += 1.0f;") == "\tvar b = b_given;\n\tb += 1.0f;\n");
	CHECK(bodyInWgsl("\tfor (int k = 0; k < 4; ++k)\n\t{\n\t\tcontinue;\n\t}") ==
		  "\tfor (var k: i32 = 0; k < 4; k++)\n\t{\n\t\tcontinue;\n\t}\n");
	CHECK(bodyInWgsl("\tif (c)\n\t{\n\t}\n\telse if (!c)\n\t{\n\t}\n\telse\n\t{\n\t}") ==
		  "\tif (c)\n\t{\n\t}\n\telse if (!c)\n\t{\n\t}\n\telse\n\t{\n\t}\n");
	CHECK(bodyInWgsl("\tbool d = i == ivec2(1, 2) && a != a;") == "\tlet d: bool = all(i == vec2i(1, 2)) && any(a != a);\n");
	CHECK(bodyInWgsl("\tfloat d = b < 1.0f ? b : -(-b);") == "\tlet d: f32 = select(-(-b), b, (b < 1.0f));\n");
	CHECK(bodyInWgsl("\treturn c ? a : a * b;") == "\tif (c)\n\t{\n\t\treturn a;\n\t}\n\treturn a * b;\n");
	CHECK(bodyInWgsl("\tbool d = c && c || c;\n\tint j = 1 + i.x & 2;\n\tfloat e = b - (b - b);") ==
		  "\tlet d: bool = (c && c) || c;\n\tlet j: i32 = (1 + i.x) & 2;\n\tlet e: f32 = b - (b - b);\n");
	CHECK(bodyInWgsl("\tfloat d = cos(b) * sin(b);") == "\tlet d: f32 = nookSin(b + 1.57079633f) * nookSin(b);\n");
	CHECK(bodyInWgsl("\tint d = bitCount(uint(i.x));") == "\tlet d: i32 = i32(countOneBits(u32(i.x)));\n");
}

TEST_CASE("wgsl: declarations of modules", "[emit]")
{
	const std::string wgsl =
		wgslOf("#ifndef SET\n#define SET 2\n#endif\n#define READ(p) texelFetch(t, p, 0).x\n#define SKY 1e30\n"
			   "// The block.\nlayout(set = SET, std140, binding = 3) uniform block\n{\n\tvec2 from; // first\n} it;\n"
			   "layout(set = SET, binding = 4) uniform highp usampler2DArray t;\n"
			   "const vec2 two[2] = vec2[2](\n\tvec2(1.0, 2.0),\n\tvec2(3.0, 4.0));\n"
			   "vec2 f(ivec3 p)\n{\n\treturn two[READ(p) == 1u ? 0 : 1] * it.from * SKY;\n}\n");
	CHECK(wgsl.find("@group(2) @binding(3) var<uniform> it: block;\n@group(2) @binding(4) var t: texture_2d_array<u32>;\n") <
		  wgsl.size());
	CHECK(wgsl.find("// The block.\nstruct block\n{\n\tfrom_: vec2f, // first\n}\n") < wgsl.size());
	CHECK(wgsl.find("const SKY = 1e30;\n") < wgsl.size());
	CHECK(wgsl.find("const two = array<vec2f, 2>(\n\tvec2f(1.0, 2.0),\n\tvec2f(3.0, 4.0),\n);\n") < wgsl.size());
	CHECK(wgsl.find("two[select(1, 0, textureLoad(t, p.xy, p.z, 0).x == 1u)] * it.from_ * SKY;\n") < wgsl.size());
}

TEST_CASE("wgsl: storage buffers, variables of a stage, functions without a result", "[emit]")
{
	CHECK(wgslOf("layout(set = 0, binding = 3) readonly buffer B\n{\n\tuvec2 b[];\n};\nvec3 v;\nvoid f(int i)\n{\n\tv = "
				 "uintBitsToFloat(uvec3(b[i].x, 0u, 0u));\n}\n")
			  .find("v = bitcast<vec3f>(vec3u(b[i].x, 0u, 0u));") != std::string::npos);
}

TEST_CASE("wgsl: refuses by name", "[emit]")
{
	const auto refused = [](const std::string& body)
	{
		return refusedInWgsl("float f(float a, ivec2 i)\n{\n\t" + body + "\n\treturn a;\n}\n");
	};
	CHECK(refusedInWgsl("float f(out float a)\n{\n\treturn a;\n}\n") ==
		  "--wgsl: f: found 'out', expected float, int, uint, bool or a vector of them");
	CHECK(refusedInWgsl("float f()\n{\n\treturn 1.0;\n}\nfloat f(int i)\n{\n\treturn 2.0;\n}\n") ==
		  "--wgsl: f: found 'f', expected one function of that name, since WGSL has no overloads");
	CHECK(refusedInWgsl("layout(binding = 0) uniform sampler3D t;\n") ==
		  "--wgsl: the module: found 'sampler3D t', expected a two-dimensional texture");
	CHECK(refusedInWgsl("layout(binding = 0) uniform b\n{\n\tfloat a[2];\n} n;\n") ==
		  "--wgsl: the module: found '[', expected ';'");
	CHECK(refusedInWgsl("#else\n").find("found '#else', expected #ifdef") < 60);
	CHECK(refused("mat3 m = mat3(1.0);").find("--wgsl: f: found 'mat3'") == 0);
	CHECK(refused("float b = 1;") == "--wgsl: f: found '1', expected a value of type f32");
	CHECK(refused("a = a * i.x;") == "--wgsl: f: found 'a * i.x', expected operands of one type");
	CHECK(refused("a = dFdx(a);").find("--wgsl: f: found 'dFdx(a)', expected a function of the module") == 0);
	CHECK(refused("a = max(a, 1);").find("--wgsl: f: found 'max(a, 1)'") == 0);
	CHECK(refused("i.xy = i;").find("--wgsl: f: found 'i.xy =', expected") == 0);
	CHECK(refused("switch (i.x) { }").find("--wgsl: f: found 'switch") == 0);
	CHECK(refused("a = unknown;") == "--wgsl: f: found 'unknown', expected a value");
	CHECK(refused("a = i.st.x;").find("--wgsl: f: found '.st'") == 0);
	CHECK(refused("if (a > 0.0) a = 1.0;") == "--wgsl: f: found 'a', expected '{'");
	const std::string whole = "float f(float a)\n{\n\tif (a > 0.0f)\n\t{\n\t\treturn a + 1.0f;\n\t}\n\treturn a;\n}\n";
	for (std::size_t size = 1; size + 1 < whole.size(); ++size) // every truncation ends, with an error or text
	{
		CHECK_FALSE(refusedInWgsl(whole.substr(0, size)).empty());
	}
}
