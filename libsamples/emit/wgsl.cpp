// SPDX-License-Identifier: GPL-3.0-or-later
// Translates the GLSL of modules for Vulkan to WGSL.
//
// Supported is the GLSL that kernels use, with the declarations around it: functions of scalars and vectors with declarations,
// assignments, if, for, while and return; constants and arrays of them; one uniform block and push constants of scalars and
// vectors; textures that texelFetch reads. Types must match as in OpenGL ES, without conversions. Everything else is refused.
#include "core/error.h"
#include "core/lists.h"
#include "emit/module_parts.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <regex>
#include <set>

namespace nook
{
namespace
{

// Names that GLSL leaves free and WGSL reserves, and functions that the translation calls. Kernels compile as C++, so the keywords
// of that language, which WGSL reserves as well, do not occur.
constexpr std::string_view kReserved =
	" alias case const_assert continuing default diagnostic enable fn let loop override requires var NULL Self abstract active "
	"as asm_fragment async attribute await become cast coherent column_major common compile compile_fragment crate debugger "
	"demote demote_to_helper extends external fallthrough filter final finally from fxgroup get groupshared highp impl "
	"implements import instanceof interface layout lowp macro macro_rules match mediump meta mod module move mut nil noinline "
	"nointerpolation non_coherent noncoherent noperspective null of package packoffset partial pass patch pixelfragment precise "
	"precision premerge priv pub readonly ref regardless require resource restrict self set shared sizeof smooth snorm std "
	"subroutine super target trait type typeof unless unorm unsafe unsized use varying wgsl where with writeonly yield select "
	"all any textureLoad countOneBits ";

// Functions of both languages whose result has the type of their arguments.
constexpr std::string_view kFunctions =
	" abs sign floor ceil fract trunc sqrt exp exp2 log log2 pow tan asin acos atan normalize min max clamp mix cross ";

// WGSL's own sine may be off by 2^-11, which changes the bits of masks.
constexpr const char* kSine = R"(
// Sine, as exact as floats are for a few turns.
fn nookSin(angle: f32) -> f32
{
	let half_turns = round(angle * 0.318309886f);
	let rest = (angle - half_turns * 3.140625f) - half_turns * 9.67653589793e-4f;
	let z = rest * rest;
	let series = -1.6666667e-1f + z * (8.3333333e-3f + z * (-1.9841270e-4f + z * (2.7557319e-6f - z * 2.5052108e-8f)));
	let sine = rest + rest * z * series;
	return select(sine, -sine, abs(half_turns % 2.0f) > 0.5f);
}
)";

// Binary operators, by how tightly they bind in GLSL.
constexpr std::array<std::string_view, 11> kOperators{"",        " || ",        " && ",    " | ",   " ^ ",    " & ",
													  " == != ", " < > <= >= ", " << >> ", " + - ", " * / % "};
enum Rank : int
{
	kAnd = 2,
	kEqual = 6,
	kLess,
	kShift,
	kSum,
	kUnary = 11,
	kWhole,
};

bool isAmong(std::string_view words, const std::string& word)
{
	return words.find(" " + word + " ") != std::string_view::npos;
}

int rankOf(const std::string& op)
{
	const auto found = std::find_if(kOperators.begin(), kOperators.end(), [&op](auto ops) { return isAmong(ops, op); });
	return found == kOperators.end() ? 0 : static_cast<int>(found - kOperators.begin());
}

// Types go by their names in WGSL.
std::string vectorOf(const std::string& scalar, int size)
{
	return size == 1 ? scalar : "vec" + std::to_string(size) + (scalar == "bool" ? "<bool>" : scalar.substr(0, 1));
}

int sizeOf(const std::string& type)
{
	return type.starts_with("vec") ? type[3] - '0' : 1;
}

std::string scalarOf(const std::string& type)
{
	return sizeOf(type) == 1 ? type : type.back() == '>' ? "bool" : type.back() + std::string("32");
}

// Empty for other types than scalars and vectors.
std::string typeNamed(const std::string& glsl)
{
	static const std::regex pattern("(float|vec[234])|(int|ivec[234])|(uint|uvec[234])|(bool|bvec[234])");
	std::smatch match;
	if (!std::regex_match(glsl, match, pattern))
	{
		return glsl == "mat4" ? "mat4x4f" : "";
	}
	const std::string scalar = match[1].matched ? "f32" : match[2].matched ? "i32" : match[3].matched ? "u32" : "bool";
	return vectorOf(scalar, glsl.find("vec") < glsl.size() ? glsl.back() - '0' : 1);
}

std::string typeOfNumber(const std::string& text)
{
	const bool whole = text.starts_with("0x") || text.find_first_of(".ef") == std::string::npos;
	return std::isdigit(static_cast<unsigned char>(text[0])) == 0 ? "" : !whole ? "f32" : text.back() == 'u' ? "u32" : "i32";
}

[[noreturn]] void refuseGlsl(const std::string& where, const std::string& found, const std::string& expected)
{
	throw Error(ExitCode::unsupported, "--wgsl: " + where + ": found " + found + ", expected " + expected);
}

// Comments of modules speak of GLSL; WGSL has neither macros nor versions, and no push constants.
std::string withoutVulkan(std::string glsl, bool complete)
{
	const char* const use =
		complete ? "// This is a complete shader. Its entry points are at the end" : "// Put it in front of your code";
	const std::array<std::array<const char*, 2>, 8> phrases{
		{{R"(// Define NOOK_\w+\([^)]*\) before this file[^\n]*)", "// Change the function that reads it to read your own."},
		 {"// This file has no #version: include it after yours", use},
		 {R"((//[^\n]*)GL_TEXTURE_MAX_LEVEL, or an image view)", "$1a view of them"},
		 {R"((//[^\n]*)define NOOK_NORMAL\(pixel\) to read)", "$1change nookNormal to read"},
		 {"(//[^\n]*)texelFetch", "$1textureLoad"},
		 {"(// +)float nook", "$1f32 nook"},
		 {R"((// +f32 nook\w+)\(ivec2 pixel)", "$1(vec2i pixel"},
		 {R"(layout\(push_constant\) uniform \w+\n\{\n\t(\w+ \w+;)\n\};)", "layout(set = NOOK_SET, binding = 16) uniform $1"}}};
	for (const auto& [pattern, by] : phrases)
	{
		glsl = std::regex_replace(glsl, std::regex(pattern), by);
	}
	return glsl;
}

// A module without its directives, and with its macros replaced. No macro is defined in front of it, so #ifndef always holds;
// #ifdef is around parts that are there, and #if rejects old versions of GLSL.
std::string preprocessed(const std::string& glsl)
{
	static const std::regex define(R"(#define (\w+)(\((\w+)\))? ?(.*?)( *//.*)?)");
	std::vector<std::pair<std::regex, std::string>> macros;
	std::string text;
	for (std::size_t at = 0; at < glsl.size(); at += 1)
	{
		std::string line = glsl.substr(at, glsl.find('\n', at) - at);
		at += line.size();
		std::smatch match;
		if (std::regex_match(line, match, define))
		{
			const std::string value = match[4];
			const std::string parameter = match[2].matched ? R"(\()" + match.str(3) + R"(\))" : "";
			macros.emplace_back(R"(\b)" + match.str(1) + (match[2].matched ? parameter : R"(\b)"), value);
			const bool constant = !value.empty() && typeOfNumber(value) == "f32";
			line = constant ? "const float " + match.str(1) + " = " + value + ";" : "";
			macros.resize(macros.size() - (constant ? 1 : 0));
		}
		else if (line.starts_with("#") && !isAmong(" #if #ifdef #ifndef #endif #error ", line.substr(0, line.find(' '))))
		{
			refuseGlsl("the module", "'" + line + "'", "#ifdef, #ifndef, #define or #endif");
		}
		for (const auto& [name, value] : macros)
		{
			line = std::regex_replace(line, name, value);
		}
		text += (line.starts_with("#") ? "" : line) + "\n";
	}
	return text;
}

struct WgslToken
{
	std::string text;
	std::vector<std::string> above{}; // comments on lines of their own before it
	std::string beside{};             // comment behind it
};

// The last token is empty.
std::vector<WgslToken> tokensOf(const std::string& text)
{
	static const std::regex pattern(
		R"((//.*)|(\n)|[A-Za-z_]\w*|0x\w+|[0-9][0-9.]*(?:e[-+]?[0-9]+)?[uf]?|[-+*/%&|^<>=!]=|<<|>>|&&|\|\||\+\+|--|\S)");
	std::vector<WgslToken> tokens(1);
	bool begins = true; // a line
	for (std::sregex_iterator part(text.begin(), text.end(), pattern); part != std::sregex_iterator(); ++part)
	{
		if ((*part)[1].matched && begins)
		{
			tokens.back().above.push_back(part->str());
		}
		else if ((*part)[1].matched)
		{
			tokens[tokens.size() - 2].beside += " " + part->str();
		}
		else if (!(*part)[2].matched)
		{
			tokens.back().text = part->str();
			tokens.emplace_back();
		}
		begins = (*part)[2].matched;
	}
	return tokens;
}

// An expression in WGSL.
struct WgslValue
{
	std::string text;
	std::string type{};
	int rank = kWhole;
	std::vector<std::string> choice{}; // of ?: at the top: condition, and both values
};

class WgslWriter
{
public:
	explicit WgslWriter(const std::string& glsl) : m_tokens(tokensOf(preprocessed(glsl))) {}

	std::string module()
	{
		while (!peek().empty())
		{
			m_where = "the module";
			declare();
		}
		return "\n// Everything that a pipeline binds. The block is laid out as std140.\n" + m_bindings + m_text +
			   (m_turns ? kSine : "");
	}

private:
	const std::string& peek() const
	{
		return m_tokens[m_at].text;
	}

	std::string next()
	{
		const std::string text = peek();
		m_at += text.empty() ? 0U : 1U;
		return text;
	}

	bool take(const std::string& text)
	{
		return peek() == text && !next().empty();
	}

	void refuseIf(bool condition, const std::string& found, const std::string& expected) const
	{
		if (condition)
		{
			refuseGlsl(m_where, "'" + found + "'", expected);
		}
	}

	void expect(const std::string& text)
	{
		refuseIf(!take(text), peek(), "'" + text + "'");
	}

	// The text in front of a mark that must follow.
	std::string ended(const std::string& text, const std::string& mark)
	{
		expect(mark);
		return text + mark;
	}

	std::string type()
	{
		const std::string word = next();
		refuseIf(typeNamed(word).empty(), word, "float, int, uint, bool or a vector of them");
		return typeNamed(word);
	}

	std::string name()
	{
		const std::string word = next();
		refuseIf(std::isalpha(static_cast<unsigned char>(word[0])) == 0, word, "a name");
		return word;
	}

	static std::string safe(const std::string& name)
	{
		return isAmong(kReserved, name) ? name + "_" : name;
	}

	// Kernels have no name for two things, since they compile without warnings of shadowed names.
	std::string declared(const std::string& name, const std::string& type)
	{
		m_types[name] = type;
		return safe(name);
	}

	std::string indent() const
	{
		return std::string(static_cast<std::size_t>(m_depth), '\t');
	}

	// Writes a line that stands for the tokens since `start`, with their comments.
	void write(std::string& text, std::size_t start, const std::string& code) const
	{
		std::string beside;
		for (std::size_t i = start; i < m_at; ++i)
		{
			text += joinedText(m_tokens[i].above, "", [&](const std::string& comment) { return indent() + comment + "\n"; });
			beside += m_tokens[i].beside;
		}
		text += indent() + code + beside + "\n";
	}

	void declare()
	{
		const std::size_t start = m_at;
		if (take("layout"))
		{
			return declareBound(start);
		}
		const bool constant = take("const");
		const std::string of = take("void") ? "" : type();
		const std::string called = name();
		m_text += "\n";
		if (take(";"))
		{
			return write(m_text, start, "var<private> " + declared(called, of) + ": " + of + ";");
		}
		if (!constant)
		{
			m_where = called;
			return declareFunction(start, of, called);
		}
		// const float name = …; const vec4 name[2] = vec4[2](…, …);
		const std::string size = take("[") ? next() : "";
		std::string text;
		if (size.empty())
		{
			expect("=");
			text = expression(of).text;
		}
		else
		{
			while (next() != "(" && !peek().empty())
			{
			}
			do
			{
				text += "\n\t" + expression(of).text + ",";
			} while (take(","));
			expect(")");
			text = "array<" + of + ", " + size + ">(" + text + "\n)";
		}
		const std::string name_text = declared(called, size.empty() ? of : "array " + of);
		write(m_text, start, ended("const " + name_text + " = " + text, ";"));
	}

	// layout(…) uniform: a texture, a number or the block
	void declareBound(std::size_t start)
	{
		std::map<std::string, std::string> layout;
		for (expect("("); !take(")"); take(","))
		{
			const std::string key = name();
			layout[key] = take("=") ? next() : "";
		}
		const std::string at = "@group(" + layout["set"] + ") @binding(" + layout["binding"] + ") var";
		const bool stored = take("readonly");
		expect(stored ? "buffer" : "uniform");
		take("highp");
		const std::string kind = name();
		static const std::regex sampler("([iu]?)sampler2D(Array)?");
		std::smatch parts;
		if (stored)
		{
			expect("{");
			const std::string of = type();
			const std::string called = declared(name(), "array " + of);
			for (const char* const mark : {"[", "]", ";", "}"})
			{
				expect(mark);
			}
			write(m_bindings, start, ended(at + "<storage, read> " + called + ": array<" + of + ">", ";"));
		}
		else if (peek() == "{")
		{
			m_text += "\n";
			write(m_text, start, "struct " + kind + "\n{");
			for (expect("{"); !take("}");)
			{
				start = m_at;
				const std::string of = type();
				const std::string member = name();
				const bool array = of == "vec4f" && take("["); // others have another stride in std140
				const std::string size = array ? next() : "";
				expect(array ? "]" : ";");
				take(";");
				m_members[member] = (array ? "array " : "") + of;
				write(m_text, start, "\t" + safe(member) + ": " + (array ? "array<" + of + ", " + size + ">" : of) + ",");
			}
			m_block = kind;
			m_text += "}\n";
			m_bindings += ended(at + "<uniform> " + declared(name(), kind) + ": " + kind, ";") + "\n";
		}
		else
		{
			std::string of = typeNamed(kind);
			const char* const space = of.empty() ? " " : "<uniform> ";
			refuseIf(of.empty() && !std::regex_match(kind, parts, sampler), kind + " " + peek(), "a two-dimensional texture");
			if (of.empty())
			{
				of = (parts[2].matched ? "texture_2d_array<" : "texture_2d<") + (parts.length(1) == 0 ? "f" : parts.str(1)) + "32>";
			}
			write(m_bindings, start, ended(at + space + declared(name(), of) + ": " + of, ";"));
		}
	}

	void declareFunction(std::size_t start, const std::string& result, const std::string& called)
	{
		refuseIf(m_functions.contains(called), called, "one function of that name, since WGSL has no overloads");
		std::vector<std::string>& types = m_functions[called];
		std::vector<std::string> names;
		declared(called, result);
		for (expect("("); !take(")"); take(","))
		{
			types.push_back(type());
			names.push_back(declared(name(), types.back()));
		}
		m_result = result;
		m_assigned.clear();
		const std::size_t head = m_at;
		const std::string before = std::exchange(m_text, "");
		block();
		std::string body = std::exchange(m_text, before);
		std::string parameters;
		for (std::size_t i = names.size(); i-- > 0;)
		{
			const bool copied = m_assigned.contains(names[i]); // parameters are constants in WGSL
			parameters = names[i] + (copied ? "_given: " : ": ") + types[i] + (parameters.empty() ? "" : ", ") + parameters;
			body.insert(2, copied ? "\tvar " + names[i] + " = " + names[i] + "_given;\n" : "");
		}
		for (const std::string& variable : m_assigned)
		{
			body = std::regex_replace(body, std::regex(R"(\blet )" + variable + ":"), "var " + variable + ":");
		}
		const std::size_t end = std::exchange(m_at, head);
		write(m_text, start, "fn " + called + "(" + parameters + ")" + (result.empty() ? "" : " -> ") + result);
		m_at = end;
		m_text += body;
	}

	void block()
	{
		std::size_t start = m_at;
		write(m_text, start, ended("", "{"));
		m_depth += 1;
		while (peek() != "}")
		{
			statement();
		}
		m_depth -= 1;
		start = m_at;
		write(m_text, start, ended("", "}"));
	}

	void statement(const std::string& before = "")
	{
		std::size_t start = m_at;
		const std::string word = peek();
		if (isAmong(" if while for ", word))
		{
			next();
			expect("(");
			const bool counts = word == "for";
			std::string head = counts ? ended(simple(), ";") + " " : "";
			head += ended(expression("bool").text, counts ? ";" : ")");
			head += counts ? " " + ended(simple(), ")") : "";
			write(m_text, start, before + word + " (" + head);
			block();
			start = m_at;
			if (word == "if" && take("else"))
			{
				if (peek() == "if")
				{
					return statement("else ");
				}
				write(m_text, start, "else");
				block();
			}
			return;
		}
		const WgslValue value = take("return") ? (m_result.empty() ? WgslValue{} : expression(m_result))
								: isAmong(" break continue discard ", word) ? WgslValue{next()}
																			: WgslValue{simple()};
		expect(";");
		if (value.choice.empty())
		{
			return write(m_text, start, (word == "return" ? "return " : "") + value.text + ";");
		}
		write(m_text, start, "if (" + value.choice[0] + ")"); // select() would evaluate both
		m_text += indent() + "{\n" + indent() + "\treturn " + value.choice[1] + ";\n" + indent() + "}\n";
		m_text += indent() + "return " + value.choice[2] + ";\n";
	}

	// A declaration, an assignment or a step, without its semicolon.
	std::string simple()
	{
		if (!typeNamed(peek()).empty())
		{
			const std::string of = type();
			const std::string called = name();
			const std::string value = take("=") ? " = " + expression(of).text : "";
			return "let " + declared(called, of) + ": " + of + value;
		}
		const std::string step = isAmong(" ++ -- ", peek()) ? next() : "";
		const std::string assigned = safe(peek());
		const WgslValue left = unary();
		if (step.empty() && left.type.empty())
		{
			return left.text; // a call
		}
		m_assigned.insert(assigned);
		const std::string op = step.empty() ? next() : step;
		if (isAmong(" ++ -- ", op))
		{
			return left.text + op;
		}
		refuseIf(!isAmong(" = += -= *= /= %= &= |= ^= ", op) || (sizeOf(left.type) > 1 && left.text.find('.') < left.text.size()),
				 left.text + " " + op, "a declaration, if, for, while, return, or an assignment to a variable or one component");
		const WgslValue right = expression();
		refuseIf(right.type != left.type && (op == "=" || right.type != scalarOf(left.type)), right.text,
				 "a value of type " + left.type);
		return left.text + " " + op + " " + right.text;
	}

	// A value in a list, where "<" could begin a template.
	static std::string listed(const WgslValue& value)
	{
		return value.rank == kLess ? "(" + value.text + ")" : value.text;
	}

	WgslValue expression(const std::string& type = "")
	{
		WgslValue value = binary(0);
		if (take("?"))
		{
			const WgslValue yes = expression();
			expect(":");
			const WgslValue no = expression(yes.type);
			const std::string text = "select(" + listed(no) + ", " + listed(yes) + ", " + listed(value) + ")";
			value = {text, yes.type, kWhole, {value.text, yes.text, no.text}};
		}
		refuseIf(!type.empty() && value.type != type, value.text, "a value of type " + type);
		return value;
	}

	// WGSL lets few operators meet without parentheses.
	static std::string operand(const WgslValue& value, int rank, bool right)
	{
		const bool compares = rank == kEqual || rank == kLess;
		const bool compared = value.rank == kEqual || value.rank == kLess;
		const bool chains = value.rank == rank && !right && !compares && rank != kShift;
		const bool binds = (rank <= kAnd && compared) || (value.rank > rank && value.rank >= kSum && (rank >= kSum || compares));
		return value.rank >= kUnary || chains || binds ? value.text : "(" + value.text + ")";
	}

	WgslValue binary(int least)
	{
		WgslValue left = unary();
		while (rankOf(peek()) > least)
		{
			const std::string op = next();
			const int rank = rankOf(op);
			WgslValue right = binary(rank);
			if (rank == kShift)
			{
				right = {"u32(" + right.text + ")", scalarOf(left.type)}; // amounts are unsigned in WGSL
			}
			if (op == "*" && left.type == "mat4x4f" && right.type == "vec4f")
			{
				left = {operand(left, rank, false) + " * " + operand(right, rank, true), "vec4f", rank};
				continue;
			}
			const bool scales = rank >= kSum && (sizeOf(left.type) == 1 || sizeOf(right.type) == 1);
			refuseIf(scales ? scalarOf(left.type) != scalarOf(right.type) : left.type != right.type,
					 left.text + " " + op + " " + right.text, "operands of one type");
			const std::string of = sizeOf(right.type) > 1 ? right.type : left.type;
			const std::string text = operand(left, rank, false) + " " + op + " " + operand(right, rank, true);
			const bool compares = rank == kEqual || rank == kLess;
			const bool whole = compares && sizeOf(of) > 1; // WGSL compares by component
			left = {whole ? (op == "==" ? "all(" : "any(") + text + ")" : text, compares ? "bool" : of, whole ? kWhole : rank};
		}
		return left;
	}

	WgslValue unary()
	{
		if (isAmong(" - ! ~ ", peek()))
		{
			const std::string op = next();
			const WgslValue value = unary();
			return {op + (value.rank < kWhole ? "(" + value.text + ")" : value.text), value.type, kUnary};
		}
		WgslValue value = primary();
		while (peek() == "." || peek() == "[")
		{
			if (next() == "[")
			{
				const std::string of = value.type.starts_with("array ") ? value.type.substr(6) : scalarOf(value.type);
				value = {operand(value, kUnary, false) + "[" + ended(expression("i32").text, "]"), of};
				continue;
			}
			const std::string member = name();
			const bool own = value.type == m_block && m_members.contains(member);
			refuseIf(!own && member.find_first_not_of("xyzw") < member.size() && member.find_first_not_of("rgba") < member.size(),
					 "." + member, "components x, y, z, w or r, g, b, a");
			value = {operand(value, kUnary, false) + "." + safe(member),
					 own ? m_members[member] : vectorOf(scalarOf(value.type), static_cast<int>(member.size()))};
		}
		return value;
	}

	WgslValue primary()
	{
		const std::string word = next();
		if (word == "(")
		{
			WgslValue value = expression();
			value.choice.clear();
			expect(")");
			return value;
		}
		if (peek() == "(")
		{
			return called(word);
		}
		const std::string number = typeOfNumber(word);
		if (!number.empty() || isAmong(" true false ", word))
		{
			return {word, number.empty() ? "bool" : number};
		}
		const auto found = m_types.find(word);
		refuseIf(found == m_types.end(), word, "a value");
		return {safe(word), found->second};
	}

	WgslValue called(const std::string& word)
	{
		std::vector<WgslValue> values;
		std::vector<std::string> types;
		std::string all;
		for (expect("("); !take(")"); take(","))
		{
			values.push_back(expression());
			types.push_back(values.back().type);
			all += (all.empty() ? "" : ", ") + listed(values.back());
		}
		const std::string made = typeNamed(word);
		const auto fits = [&made](const std::string& type)
		{
			return scalarOf(type) == scalarOf(made);
		};
		if (!made.empty() && (types.size() == 1 || std::all_of(types.begin(), types.end(), fits)))
		{
			return {made + "(" + all + ")", made};
		}
		const auto function = m_functions.find(word);
		if (function != m_functions.end() && function->second == types)
		{
			return {word + "(" + all + ")", m_types[word]};
		}
		if (word == "texelFetch" && types.size() == 3 && types[0].starts_with("texture"))
		{
			const std::string place = operand(values[1], kUnary, false);
			const std::string at = types[1] == "vec3i" ? place + ".xy, " + place + ".z" : place; // a separate layer
			return {"textureLoad(" + values[0].text + ", " + at + ", " + values[2].text + ")",
					vectorOf(types[0].substr(types[0].size() - 4, 3), 4)};
		}
		const bool alike = !types.empty() && std::count(types.begin(), types.end(), types[0]) == std::ssize(types);
		if (alike && (isAmong(kFunctions, word) || isAmong(" dot length distance ", word)))
		{
			return {word + "(" + all + ")", isAmong(kFunctions, word) ? types[0] : "f32"};
		}
		if (alike && isAmong(" sin cos ", word) && types[0] == "f32")
		{
			m_turns = true;
			return {"nookSin(" + all + (word == "cos" ? " + 1.57079633f)" : ")"), "f32"};
		}
		if (types.size() == 1 && (word == "uintBitsToFloat" || word == "floatBitsToUint"))
		{
			const std::string of = vectorOf(word[0] == 'u' ? "f32" : "u32", sizeOf(types[0]));
			return {"bitcast<" + of + ">(" + all + ")", of};
		}
		if (alike && word == "bitCount" && types[0] == "u32")
		{
			return {"i32(countOneBits(" + all + "))", "i32"};
		}
		refuseGlsl(m_where, "'" + word + "(" + all + ")'",
				   "a function of the module, or one of" + std::string(kFunctions) +
					   "sin cos dot length distance bitCount texelFetch, with arguments of its types");
	}

	std::vector<WgslToken> m_tokens;
	std::size_t m_at = 0;
	int m_depth = 0;
	std::string m_where; // for messages
	std::string m_bindings;
	std::string m_text;
	std::map<std::string, std::string> m_types;                  // of names
	std::map<std::string, std::vector<std::string>> m_functions; // → types of their parameters
	bool m_turns = false;                                        // calls nookSin
	std::string m_block;                                         // type of the uniform block
	std::map<std::string, std::string> m_members;                // of the block → types
	std::string m_result;                                        // type of the function being written
	std::set<std::string> m_assigned;                            // names to which it assigns
};

constexpr const char* kVolumesEntries = R"(
// 1: neither the near nor the far plane cuts volumes. Draw without a depth test then, where the device has no depth-clip-control.
override nook_any_depth: f32 = 0.0;

struct NookBetween
{
	@builtin(position) position: vec4f,
	@location(0) @interpolate(flat) polygon: vec4i,
	@location(1) @interpolate(flat) front: vec4f,
	@location(2) @interpolate(flat) offset: vec3f,
	@location(3) @interpolate(flat) step: vec3f,
}

fn nookBetween(position: vec4f) -> NookBetween
{
	let place = vec4f(position.xy, select(position.z, 0.0, nook_any_depth > 0.5), position.w);
	return NookBetween(place, nook_polygon, nook_front, nook_offset, nook_step);
}

@vertex
fn nook_vertex(@builtin(vertex_index) vertex: u32, @builtin(instance_index) cluster: u32) -> NookBetween
{
	return nookBetween(nookPolygonVertex(i32(cluster), i32(vertex)));
}

@vertex
fn nook_prism_vertex(@location(0) point: vec4u, @builtin(instance_index) cluster: u32) -> NookBetween
{
	return nookBetween(nookPrismVertex(i32(cluster), point));
}

@fragment
fn nook_fragment(between: NookBetween) -> @location(0) vec4f
{
	nook_polygon = between.polygon;
	nook_front = between.front;
	nook_offset = between.offset;
	nook_step = between.step;
	return vec4f(nookOcclusion(vec2i(between.position.xy) * nook.cell), 0.0, 0.0, 1.0);
}

@fragment
fn nook_resolve(@builtin(position) place: vec4f) -> @location(0) vec4f
{
	return vec4f(nookResolved(vec2i(place.xy)), 0.0, 0.0, 1.0);
}

@fragment
fn nook_sparse(@builtin(position) place: vec4f) -> @location(0) vec4f
{
	return vec4f(nookKnown(vec2i(place.xy)), 0.0, 0.0, 1.0);
}
)";

std::string triangleText(const std::string& name)
{
	return "\n// The vertices of a triangle that covers the picture: draw three.\n@vertex\nfn " + name +
		   "(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f\n{\n"
		   "\treturn vec4f(f32(i & 1u) * 4.0 - 1.0, f32(i >> 1u) * 4.0 - 1.0, 0.0, 1.0);\n}\n";
}

// An entry point per pass, since WGSL has no macros to choose one: main, or main_nookVoLineLinked and so on.
std::string entriesText(const ModuleSettings& settings)
{
	static const std::map<std::string, std::string> formats{{"r8", "r32float"},         {"r32f", "r32float"},
															{"rgba8", "rgba8unorm"},    {"rgba16f", "rgba16float"},
															{"rgba32f", "rgba32float"}, {"rgba32ui", "rgba32uint"}};
	const bool compute = settings.main == ModuleMain::compute;
	std::string text =
		compute ? "\n// Dispatch as many groups of 8 x 8 as cover the picture that is written.\n" : triangleText("triangle");
	const std::vector<ModulePass> passes = mainPasses(settings);
	for (const ModulePass& pass : passes)
	{
		const std::string name = "main" + (passes.size() > 1 ? "_" + pass.call.substr(0, pass.call.find('(')) : "");
		const std::string value = pass.type == "float" ? "vec4f(" + pass.call + ", 0.0, 0.0, 1.0)" : pass.call;
		text += compute ? "\n@group(0) @binding(15) var nook_out_" + name + ": texture_storage_2d<" + formats.at(pass.format) +
							  ", write>;\n@compute\n@workgroup_size(8, 8)\nfn " + name +
							  "(@builtin(global_invocation_id) id: vec3u)\n{\n\tlet at = vec2i(id.xy);\n"
							  "\tif (all(id.xy < textureDimensions(nook_out_" +
							  name + ")))\n\t{\n\t\ttextureStore(nook_out_" + name + ", at, " + value + ");\n\t}\n}\n"
						: "\n@fragment\nfn " + name + "(@builtin(position) place: vec4f) -> @location(0) " +
							  (pass.type == "uvec4" ? "vec4u" : "vec4f") + "\n{\n\tlet at = vec2i(place.xy);\n\treturn " + value +
							  ";\n}\n";
	}
	return text;
}

} // namespace

std::string wgslOf(const std::string& glsl)
{
	return WgslWriter(glsl).module();
}

std::string volumesWgsl(const std::string& glsl)
{
	std::string once; // stages repeat what they share, between empty lines
	std::set<std::string> parts;
	for (std::size_t at = 0, end = 0; at < glsl.size(); at = end + 2)
	{
		end = std::min(glsl.find("\n\n", at), glsl.size());
		const std::string part = glsl.substr(at, end - at);
		once += parts.insert(part).second ? part + "\n\n" : "";
	}
	return wgslOf(once) + kVolumesEntries + triangleText("nook_triangle");
}

std::string moduleWgsl(const ModuleSettings& settings, const EmitContext& context)
{
	ModuleSettings functions = settings;
	functions.target = GlslTarget::vulkan;
	functions.main.reset();
	const std::string glsl = withoutVulkan(moduleGlsl(functions, context), settings.main.has_value());
	const std::string head = glsl.substr(0, glsl.find("\n#") + 1);
	return head + wgslOf(glsl.substr(head.size())) + (settings.main ? entriesText(settings) : "");
}

} // namespace nook
