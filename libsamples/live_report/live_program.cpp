// SPDX-License-Identifier: GPL-3.0-or-later
// The npm package → the program as it runs in a worker of the page.
#include "core/error.h"
#include "core/file.h"
#include "live_report/live_parts.h"
#include "page/assets.h"

namespace nook
{
namespace
{

// Where a script of the package says what the page says in another way. Throws Error (invalid_input) where it does not say it.
void replaceOnce(std::string& script, const std::string& name, std::string_view found, std::string_view by)
{
	const std::size_t at = script.find(found);
	if (at == std::string::npos)
	{
		throw Error(ExitCode::invalid_input,
					name + ": found no '" + std::string(found) + "', expected the npm package of this version");
	}
	script.replace(at, found.size(), by);
}

void removeAll(std::string& script, std::string_view word)
{
	for (std::size_t at = 0; (at = script.find(word, at)) != std::string::npos;)
	{
		script.erase(at, word.size());
	}
}

void checkVersion(const std::string& name, const std::string& text, const std::string& version)
{
	const LiveJson package = LiveJson::parse(text, nullptr, false);
	const bool has = package.is_object() && package.contains("version") && package["version"].is_string();
	const std::string found = has ? package["version"].get<std::string>() : "none";
	if (found != version)
	{
		throw Error(ExitCode::invalid_input,
					name + ": version: found " + found + ", expected " + version + ", that of this program");
	}
}

} // namespace

LiveJson liveProgram(const LiveReportSettings& settings, std::vector<std::string>& read)
{
	const auto file = [&](const char* name)
	{
		read.push_back(settings.package + "/" + name);
		return readFile(read.back());
	};
	checkVersion(settings.package + "/package.json", file("package.json"), settings.version);
	std::string module = file("nook_module.js"); // one script of both: a blob imports no file
	replaceOnce(module, read.back(), "export default Module;", "");
	std::string calls = file("calls.js");
	replaceOnce(calls, read.back(), "import makeModule from './nook_module.js';", "const makeModule = Module;");
	removeAll(calls, "export ");
	const std::string wasm = file("nook.wasm");
	if (!wasm.starts_with(std::string_view("\0asm", 4)))
	{
		throw Error(ExitCode::invalid_input,
					read.back() + ": found " + std::to_string(wasm.size()) + " bytes, expected WebAssembly");
	}
	const std::span<const char> bytes(wasm);
	return {{"worker", module + calls + std::string(assets::live_worker_js)}, {"wasm", packed(bytes)}};
}

} // namespace nook
