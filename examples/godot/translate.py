# SPDX-License-Identifier: MIT
# Usage: translate.py MODULE.glsl FUNCTION OUT.shader. Translates a module of `nook emit --glsl 330 --block floats` to the shading
# language of Godot 3, which has no uniform blocks, macros, hexadecimal numbers or suffix f, and writes a canvas shader that draws one
# of its passes.
import re
import sys

module, function, out = sys.argv[1:]
text = re.sub(r"//.*", "", open(module, encoding="utf-8").read())
# The depth of depth.shader.
text = text.replace("texelFetch(nook_depths, pixel, 0).r\n",
                    "dot(floor(texelFetch(nook_depths, pixel, 0).rgb * 255.0), vec3(65536.0, 256.0, 1.0)) / 16777215.0\n")
# Members of the block become uniforms: nook.size is nook_size.
text = re.sub(r"layout\(std140\) uniform nook_block\s*{(.*?)} nook;",
              lambda block: re.sub(r"(\w+ )(\w+;)", r"uniform \1nook_\2", block[1]), text, flags=re.S)
text = re.sub(r"\bnook\.", "nook_", text)
# Every #ifndef asks for a macro that may be defined first; none is.
macros = re.findall(r"#define (\w+)(?:\((\w+)\))? +(.+)", text)
text = re.sub(r"#.*", "", text)
for name, parameter, body in macros:
    pattern = rf"\b{name}\b" + (r"\((\w+)\)" if parameter else "")
    text = re.sub(pattern, lambda use: re.sub(rf"\b{parameter}\b", use[1], body) if parameter else body, text)
text = re.sub(r"\b0x[0-9a-f]+", lambda number: str(int(number[0], 16)), text)
text = re.sub(r"\b(\d{5})(\d{3})\.0f?\b", r"(\g<1>000.0 + \2.0)", text)  # Godot 3 keeps six digits of a float
text = re.sub(r"(\d)f\b", r"\1", text)
text = re.sub(r"\n\s*\n+", "\n", text)
with open(out, "w", encoding="utf-8") as file:
    file.write(f"shader_type canvas_item;\nrender_mode blend_disabled;\n{text}\nvoid fragment()\n{{\n"
               f"\tCOLOR = vec4(vec3({function}(ivec2(FRAGCOORD.xy))), 1.0);\n}}\n")
