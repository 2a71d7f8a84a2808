// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/system.h"

#include <array>
#include <cerrno>
#include <csignal>
#include <filesystem>

#define WIN32_LEAN_AND_MEAN
#include <fcntl.h>
#include <io.h>
#include <windows.h>

#include <shellapi.h> // needs <windows.h> first

namespace nook
{
namespace
{

std::wstring wide(const char* text)
{
	return nativePath(text).wstring();
}

std::string narrow(const wchar_t* text)
{
	return std::filesystem::path(text).string(); // UTF-8
}

} // namespace

std::FILE* openFile(const std::string& path, const char* mode)
{
	std::error_code ignored;
	if (std::filesystem::is_directory(nativePath(path), ignored))
	{
		errno = EISDIR; // would be EACCES otherwise
		return nullptr;
	}
	return ::_wfopen(wide(path.c_str()).c_str(), wide(mode).c_str());
}

// On Windows, signal handlers run on their own thread or where the signal is raised.
void removeFile(const char* path) noexcept
{
	std::array<wchar_t, 32768> name{}; // longest path
	if (::MultiByteToWideChar(CP_UTF8, 0, path, -1, name.data(), static_cast<int>(name.size())) > 0)
	{
		::DeleteFileW(name.data());
	}
}

void removeFolder(const char* path) noexcept
{
	std::array<wchar_t, 32768> name{}; // longest path
	if (::MultiByteToWideChar(CP_UTF8, 0, path, -1, name.data(), static_cast<int>(name.size())) > 0)
	{
		::RemoveDirectoryW(name.data());
	}
}

std::optional<std::string> identityOfFile(const std::string& path)
{
	const HANDLE file = ::CreateFileW(wide(path.c_str()).c_str(), 0, FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE,
									  nullptr, OPEN_EXISTING, FILE_FLAG_BACKUP_SEMANTICS, nullptr);
	BY_HANDLE_FILE_INFORMATION found{};
	const bool known = file != INVALID_HANDLE_VALUE && ::GetFileInformationByHandle(file, &found) != 0;
	if (file != INVALID_HANDLE_VALUE)
	{
		::CloseHandle(file);
	}
	if (!known)
	{
		return std::nullopt;
	}
	return std::to_string(found.dwVolumeSerialNumber) + ":" + std::to_string(found.nFileIndexHigh) + ":" +
		   std::to_string(found.nFileIndexLow);
}

// Most folders are case-insensitive.
std::string nameKey(const std::string& path)
{
	std::wstring key = wide(path.c_str());
	::CharLowerW(key.data());
	return narrow(key.c_str());
}

// Only trying shows whether a folder is writable; no other program uses this name.
bool isOpenFolder(const std::string& folder)
{
	if (::_waccess(wide(folder.c_str()).c_str(), 0) != 0)
	{
		return false;
	}
	const std::wstring name = wide(folder.c_str()) + L"\\nook.tmp" + std::to_wstring(processNumber());
	const HANDLE file = ::CreateFileW(name.c_str(), GENERIC_WRITE, 0, nullptr, CREATE_NEW,
									  FILE_ATTRIBUTE_TEMPORARY | FILE_FLAG_DELETE_ON_CLOSE, nullptr);
	if (file == INVALID_HANDLE_VALUE)
	{
		errno = ::GetLastError() == ERROR_ACCESS_DENIED ? EACCES : 0;
		return errno == 0; // any other reason is reported by the write itself
	}
	::CloseHandle(file);
	return true;
}

FileLock::FileLock(const std::string&) {}

FileLock::~FileLock() = default;

unsigned long processNumber()
{
	return ::GetCurrentProcessId();
}

double threadSeconds()
{
	FILETIME made{};
	FILETIME ended{};
	FILETIME kernel{};
	FILETIME user{};
	if (::GetThreadTimes(::GetCurrentThread(), &made, &ended, &kernel, &user) == 0)
	{
		return -1.0;
	}
	const auto seconds = [](const FILETIME& time)
	{
		return 1e-7 * (4294967296.0 * static_cast<double>(time.dwHighDateTime) + static_cast<double>(time.dwLowDateTime));
	};
	return seconds(kernel) + seconds(user);
}

std::vector<std::string> takeCommandLine(int /*argc*/, char** /*argv*/)
{
	::_setmode(_fileno(stdout), _O_BINARY);
	::_setmode(_fileno(stderr), _O_BINARY);
	::SetConsoleOutputCP(CP_UTF8);
	int count = 0;
	wchar_t** const words = ::CommandLineToArgvW(::GetCommandLineW(), &count); // the code page may lack some letters
	std::vector<std::string> arguments;
	for (int i = 0; i < count; ++i)
	{
		arguments.push_back(narrow(words[i]));
	}
	::LocalFree(words);
	return arguments;
}

void waitForEnd()
{
	::Sleep(1);
}

void onEndingSignals(void (*handler)(int))
{
	for (const int signal : {SIGINT, SIGTERM, SIGBREAK})
	{
		if (std::signal(signal, handler) == SIG_IGN)
		{
			std::signal(signal, SIG_IGN);
		}
	}
}

void endBySignal(int signal)
{
	std::signal(signal, SIG_DFL);
	std::raise(signal);
}

bool isTerminal()
{
	DWORD mode = 0; // fails unless it is a console; one without escape sequences shows no progress
	const HANDLE console = ::GetStdHandle(STD_ERROR_HANDLE);
	return ::GetConsoleMode(console, &mode) != 0 && ::SetConsoleMode(console, mode | ENABLE_VIRTUAL_TERMINAL_PROCESSING) != 0;
}

bool isTerminal(std::FILE* stream)
{
	return ::_isatty(::_fileno(stream)) != 0;
}

} // namespace nook
