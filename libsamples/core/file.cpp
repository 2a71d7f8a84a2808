// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/file.h"

#include "core/content_hash.h"
#include "core/error.h"
#include "core/lists.h"
#include "core/system.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <memory>
#include <utility>

namespace nook
{
namespace
{

struct Closer
{
	void operator()(std::FILE* file) const
	{
		std::fclose(file);
	}
};
using File = std::unique_ptr<std::FILE, Closer>;

[[noreturn]] void fail(const std::string& path, const char* doing, int reason)
{
	throw Error(ExitCode::file, path + ": cannot be " + doing + ": " + std::strerror(reason));
}

File opened(const std::string& path, const char* mode, const std::string& name, const char* doing)
{
	File file(openFile(path, mode));
	if (file == nullptr)
	{
		fail(name, doing, errno);
	}
	return file;
}

void writeAll(std::FILE* file, const std::string& path, std::string_view bytes)
{
	if (std::fwrite(bytes.data(), 1, bytes.size(), file) != bytes.size() || std::fflush(file) != 0)
	{
		fail(path, "written", errno);
	}
}

// Calls use(block) with the contents in blocks of a whole number of words.
template <class Use> void readBlocks(const std::string& path, const Use& use)
{
	const File file = opened(path, "rb", path, "read");
	std::array<char, 65536> block;
	for (std::size_t size = block.size(); size == block.size();)
	{
		size = std::fread(block.data(), 1, block.size(), file.get());
		use(std::string_view(block.data(), size));
	}
	if (std::ferror(file.get()) != 0)
	{
		fail(path, "read", errno);
	}
}

// In the target's folder, so that the rename stays in one file system; libraries choose a format by the extension.
std::filesystem::path temporaryFor(const std::filesystem::path& target)
{
	static std::atomic<unsigned> number{0}; // keeps names unique within the process
	std::filesystem::path name = target.stem();
	name += ".tmp" + std::to_string(processNumber()) + "_" + std::to_string(number++);
	name += target.extension();
	return target.parent_path() / name;
}

// Follows links; the target need not exist.
std::filesystem::path linkTarget(std::filesystem::path path)
{
	std::error_code failed;
	for (int links = 0; links < 40 && std::filesystem::is_symlink(path, failed); ++links) // Linux's limit
	{
		path = path.parent_path() / std::filesystem::read_symlink(path, failed);
	}
	return path;
}

bool isDevice(const std::string& path)
{
	std::error_code ignored;
	const std::filesystem::file_status status = std::filesystem::status(nativePath(path), ignored);
	return std::filesystem::exists(status) && !std::filesystem::is_regular_file(status);
}

void writeDirectly(const std::string& path, const std::string& name, std::string_view bytes)
{
	File file = opened(path, "wb", name, "written");
	writeAll(file.get(), name, bytes);
	if (std::fclose(file.release()) != 0)
	{
		fail(name, "written", errno);
	}
}

enum class Side
{
	target,
	source,
};

// Ninja ends a name at each of these and cannot escape them. In Make, ; and != start commands, = sets a variable and the others are
// globs, except " & ' < > ^ ` |.
constexpr std::string_view kNever = "\"&'*;<=>?[^`|";
// At a name's end these escape what follows (\ and blank), end a Ninja target (:) or mark an archive member in Make.
constexpr std::string_view kNeverLast = " \\:)";
// Make and Ninja disagree on how many backslashes escape these after a literal backslash.
constexpr std::string_view kNeverBehindBackslash = "#:$%";

std::string spoken(char c)
{
	const auto code = static_cast<unsigned char>(c);
	if (code > 0x20 && code != 0x7F)
	{
		return std::string("'") + c + "'";
	}
	char text[8];
	std::snprintf(text, sizeof text, "\\x%02X", code);
	return c == ' ' ? "a blank" : c == '\n' || c == '\r' ? "a line break" : text;
}

void check(const std::string& path, Side side)
{
	const auto refuse = [&](char c, const char* where)
	{
		throw Error(ExitCode::unsupported,
					path + ": found " + spoken(c) + where + ", expected a name that a depfile for Make and Ninja can hold");
	};
	std::size_t start = 0;
	while (path.compare(start, 2, "./") == 0)
	{
		start = std::min(path.find_first_not_of('/', start + 1), path.size());
	}
	if (path.compare(start, 1, "~") == 0) // Make expands ~ even after a stripped ./
	{
		refuse('~', " at the start");
	}
	for (std::size_t i = 0; i < path.size(); ++i)
	{
		const char c = path[i];
		const bool control = static_cast<unsigned char>(c) < 0x20 || c == 0x7F;
		if (control || kNever.find(c) != std::string_view::npos ||
			(side == Side::target && c == '%')) // % in a target makes a pattern rule
		{
			refuse(c, "");
		}
		if (i > 0 && path[i - 1] == '\\' && kNeverBehindBackslash.find(c) != std::string_view::npos)
		{
			refuse(c, " behind a backslash");
		}
	}
	if (path.empty() || kNeverLast.find(path.back()) != std::string_view::npos)
	{
		refuse(path.empty() ? ' ' : path.back(), " at the end");
	}
}

std::string escaped(const std::string& path, Side side)
{
	check(path, side);
	std::string text;
	std::size_t backslashes = 0; // number directly before the current character
	for (const char c : path)
	{
		if (c == ' ')
		{
			text.append(backslashes, '\\'); // before a blank, backslashes must be escaped; elsewhere they are literal
		}
		if (c == ' ' || c == '#' || c == ':')
		{
			text += '\\';
		}
		if (c == '$')
		{
			text += '$';
		}
		text += c;
		backslashes = c == '\\' ? backslashes + 1 : 0;
	}
	return text;
}

std::string textOf(const std::filesystem::path& path)
{
	const std::u8string text = path.u8string();
	return {text.begin(), text.end()};
}

constexpr int kEnding = -1;
std::atomic<int> holds{0};   // nesting depth of holds, or kEnding
std::atomic<int> pending{0}; // signal received meanwhile
static_assert(std::atomic<int>::is_always_lock_free && std::atomic<void*>::is_always_lock_free);

// While another thread ends the program, no file may be created or renamed.
void waitIfEnding()
{
	while (holds == kEnding)
	{
		waitForEnd();
	}
}

// Runs in a signal handler: async-signal-safe calls only.
void end(int signal)
{
	const int before = errno;
	int free = 0;
	while (!holds.compare_exchange_strong(free, kEnding))
	{
		if (free == kEnding)
		{
			return; // a second signal
		}
		pending = signal;
		if (holds != 0)
		{
			errno = before;
			return; // ~SignalsHeld() handles it
		}
		free = 0;
	}
	removeTemporaryFiles();
	endBySignal(signal);
}

} // namespace

std::string readFile(const std::string& path)
{
	std::string bytes;
	std::error_code unknown; // unknown for a pipe, for example
	const std::uintmax_t size = std::filesystem::file_size(nativePath(path), unknown);
	const auto checkSize = [&path](std::uintmax_t so_far)
	{
		if (so_far > kMaxFileBytes)
		{
			fail(path, "read", EFBIG);
		}
	};
	if (!unknown)
	{
		checkSize(size); // before allocating any memory
		bytes.reserve(static_cast<std::size_t>(size));
	}
	readBlocks(path,
			   [&](std::string_view block)
			   {
				   bytes += block;
				   checkSize(bytes.size());
			   });
	return bytes;
}

std::string hashOfFile(const std::string& path)
{
	ContentHash hash;
	readBlocks(path, [&hash](std::string_view block) { hash.add(std::as_bytes(std::span(block.data(), block.size()))); });
	return hash.text();
}

void checkWritable(const std::string& path)
{
	if (path == "-")
	{
		return;
	}
	std::error_code ignored;
	if (std::filesystem::is_directory(nativePath(path), ignored))
	{
		fail(path, "written", EISDIR);
	}
	if (isDevice(path))
	{
		return;
	}
	std::filesystem::path folder = linkTarget(nativePath(path)).parent_path();
	if (folder.empty())
	{
		folder = ".";
	}
	if (!isOpenFolder(folder.string()))
	{
		fail(path, "written", errno);
	}
	if (!std::filesystem::is_directory(folder, ignored))
	{
		fail(path, "written", ENOTDIR);
	}
}

std::string fileIdentity(const std::string& path)
{
	if (path == "-")
	{
		return path;
	}
	if (const std::optional<std::string> identity = identityOfFile(path))
	{
		return *identity;
	}
	const std::filesystem::path target = linkTarget(std::filesystem::absolute(nativePath(path)));
	std::error_code failed;
	const std::filesystem::path folder = std::filesystem::weakly_canonical(target.parent_path(), failed);
	return nameKey(((failed ? target.parent_path().lexically_normal() : folder) / target.filename()).string());
}

void writeFile(const std::string& path, std::string_view bytes)
{
	OutputSet outputs;
	outputs.add(path, bytes);
	outputs.commit();
}

void OutputSet::add(const std::string& path, std::string_view bytes)
{
	if (path == "-" || isDevice(path))
	{
		m_directs.push_back({path, std::string(bytes)});
		return;
	}
	// Links are kept; their target is replaced.
	const std::filesystem::path target = linkTarget(nativePath(path));
	TemporaryFile temporary(temporaryFor(target).string());
	writeDirectly(temporary.path(), path, bytes);
	m_renamings.push_back({std::move(temporary), target.string(), path, {}});
}

void OutputSet::commit()
{
	for (const Direct& direct : std::exchange(m_directs, {}))
	{
		if (direct.path == "-")
		{
			writeAll(stdout, "standard output", direct.bytes);
		}
		else
		{
			writeDirectly(direct.path, direct.path, direct.bytes);
		}
	}
	const SignalsHeld held; // a signal in between would leave a mix of new and old files
	for (std::size_t i = 0; i < m_renamings.size(); ++i)
	{
		Renaming& renaming = m_renamings[i];
		if (i + 1 < m_renamings.size()) // the last rename is atomic; only earlier ones may need undoing
		{
			keepOld(renaming);
		}
		std::error_code failed;
		renaming.temporary.rename(renaming.target, failed);
		if (failed)
		{
			takeBack(i);
			const std::string path = renaming.path;
			m_renamings.clear();
			fail(path, "written", failed.default_error_condition().value());
		}
	}
	m_renamings.clear(); // removes the backups
}

// Keeps the file about to be replaced as a hard link, or as a copy on file systems without hard links.
void OutputSet::keepOld(Renaming& renaming)
{
	std::error_code failed;
	const std::filesystem::path target = nativePath(renaming.target);
	if (!std::filesystem::exists(target, failed))
	{
		return;
	}
	const TemporaryFile& old = renaming.old.emplace(temporaryFor(target).string());
	std::filesystem::create_hard_link(target, nativePath(old.path()), failed);
	if (failed)
	{
		std::filesystem::copy_file(target, nativePath(old.path()), failed);
	}
	if (failed)
	{
		renaming.old.reset();
	}
}

// Undoes the first `count` renames.
void OutputSet::takeBack(std::size_t count)
{
	for (std::size_t done = 0; done < count; ++done)
	{
		std::error_code ignored;
		if (m_renamings[done].old)
		{
			m_renamings[done].old->rename(m_renamings[done].target, ignored);
		}
		else
		{
			std::filesystem::remove(nativePath(m_renamings[done].target), ignored);
		}
	}
}

// A handler may run at any time in any thread, so names are stored in entries that never move and are never freed.
struct TemporaryFile::Entry
{
	enum State
	{
		unused,
		changing,
		valid,
	};
	std::atomic<State> state = changing;
	bool is_folder = false;
	char path[4096] = "";
	Entry* next = nullptr;
};

std::atomic<TemporaryFile::Entry*> TemporaryFile::s_entries{nullptr};

void handleSignals()
{
	onEndingSignals(&end);
}

void removeTemporaryFiles()
{
	// First the files; then each pass removes at least the innermost folders.
	constexpr int kDepth = 16;
	for (int pass = 0; pass <= kDepth; ++pass)
	{
		for (TemporaryFile::Entry* entry = TemporaryFile::s_entries; entry != nullptr; entry = entry->next)
		{
			if (entry->state == TemporaryFile::Entry::valid && entry->is_folder == (pass > 0))
			{
				entry->is_folder ? removeFolder(entry->path) : removeFile(entry->path);
			}
		}
	}
}

SignalsHeld::SignalsHeld()
{
	for (int count = holds; count == kEnding || !holds.compare_exchange_weak(count, count + 1); count = holds)
	{
		waitIfEnding();
	}
}

SignalsHeld::~SignalsHeld()
{
	holds -= 1;
	const int signal = holds == 0 ? pending.exchange(0) : 0;
	if (signal != 0)
	{
		std::raise(signal);
	}
}

TemporaryFile::Entry* TemporaryFile::entryOf(const std::string& path, bool is_folder)
{
	Entry* entry = s_entries;
	for (; entry != nullptr; entry = entry->next)
	{
		Entry::State unused = Entry::unused;
		if (entry->state.compare_exchange_strong(unused, Entry::changing))
		{
			break;
		}
	}
	if (entry == nullptr)
	{
		entry = new Entry; // NOLINT: there is no moment at which no handler may read it
		entry->next = s_entries;
		while (!s_entries.compare_exchange_weak(entry->next, entry))
		{
		}
	}
	const bool fits = path.size() < sizeof entry->path; // longer paths cannot exist
	entry->path[fits ? path.copy(entry->path, path.size()) : 0] = '\0';
	entry->is_folder = is_folder;
	entry->state = Entry::valid;
	return entry;
}

TemporaryFile::TemporaryFile(std::string path) : m_path(std::move(path)), m_entry(entryOf(m_path, false))
{
	waitIfEnding();
}

TemporaryFile::TemporaryFile(TemporaryFile&& other) noexcept
	: m_path(std::move(other.m_path)), m_entry(std::exchange(other.m_entry, nullptr))
{
}

TemporaryFile::~TemporaryFile()
{
	if (m_entry != nullptr)
	{
		removeFile(m_path.c_str());
		m_entry->state = Entry::unused;
	}
}

void TemporaryFile::rename(const std::string& target, std::error_code& failed)
{
	std::filesystem::rename(nativePath(m_path), nativePath(target), failed);
	if (!failed)
	{
		m_entry->state = Entry::unused;
		m_entry = nullptr;
	}
}

void NewFolders::make(const std::filesystem::path& path, std::error_code& failed)
{
	failed.clear();
	std::filesystem::path so_far;
	for (const std::filesystem::path& part : path)
	{
		so_far /= part;
		if (part.empty() || std::filesystem::is_directory(so_far, failed))
		{
			continue;
		}
		const SignalsHeld both; // creation and registration must not be separated
		if (std::filesystem::create_directory(so_far, failed))
		{
			m_entries.push_back(TemporaryFile::entryOf(textOf(so_far), true));
		}
		if (failed)
		{
			return;
		}
	}
}

NewFolders::~NewFolders()
{
	for (; !m_entries.empty(); m_entries.pop_back())
	{
		removeFolder(m_entries.back()->path);
		m_entries.back()->state = TemporaryFile::Entry::unused;
	}
}

std::string unescaped(const std::string& uri)
{
	const auto hex = [](char c)
	{
		return c >= '0' && c <= '9' ? c - '0' : c >= 'a' && c <= 'f' ? c - 'a' + 10 : c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
	};
	std::string text;
	for (std::size_t i = 0; i < uri.size(); ++i)
	{
		if (uri[i] == '%' && i + 2 < uri.size() && hex(uri[i + 1]) >= 0 && hex(uri[i + 2]) >= 0)
		{
			text.push_back(static_cast<char>(static_cast<unsigned char>(16 * hex(uri[i + 1]) + hex(uri[i + 2]))));
			i += 2;
		}
		else
		{
			text.push_back(uri[i]);
		}
	}
	return text;
}

std::string escapedUri(const std::string& name)
{
	constexpr std::string_view kDigits = "0123456789ABCDEF";
	constexpr std::string_view kEscaped = " \"#%<>?[\\]^`{|}:";
	std::string uri;
	for (const char c : name)
	{
		const auto byte = static_cast<unsigned char>(c);
		const bool plain = byte > 32 && byte < 127 && kEscaped.find(c) == std::string_view::npos;
		uri += plain ? std::string(1, c) : std::string{'%', kDigits[byte >> 4U], kDigits[byte & 15U]};
	}
	return uri;
}

std::string depfileText(std::span<const std::string> targets, std::span<const std::string> sources)
{
	std::string text = joinedText(targets, " ", [](const std::string& target) { return escaped(target, Side::target); }) + ":";
	text += joinedText(sources, "", [](const std::string& source) { return " \\\n  " + escaped(source, Side::source); });
	return text + "\n";
}

} // namespace nook
