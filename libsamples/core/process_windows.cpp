// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/process.h"

#include "core/system.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <system_error>
#include <vector>

#define WIN32_LEAN_AND_MEAN
#include <windows.h>

#include <psapi.h> // needs <windows.h> first

namespace nook
{
namespace
{

HANDLE handleOf(std::intptr_t number)
{
	return reinterpret_cast<HANDLE>(number); // NOLINT: a handle is a number
}

std::intptr_t numberOf(HANDLE handle)
{
	return reinterpret_cast<std::intptr_t>(handle); // NOLINT: the same
}

PROCESS_MEMORY_COUNTERS memoryOf(HANDLE process)
{
	PROCESS_MEMORY_COUNTERS memory{};
	::GetProcessMemoryInfo(process, &memory, sizeof memory);
	return memory;
}

[[noreturn]] void fail()
{
	throw std::system_error(static_cast<int>(::GetLastError()), std::system_category());
}

// Windows ends the processes in this job when this program ends, however it does.
HANDLE jobOfWorkers()
{
	static const HANDLE job = []
	{
		const HANDLE made = ::CreateJobObjectW(nullptr, nullptr);
		JOBOBJECT_EXTENDED_LIMIT_INFORMATION limits{};
		limits.BasicLimitInformation.LimitFlags = JOB_OBJECT_LIMIT_KILL_ON_JOB_CLOSE;
		::SetInformationJobObject(made, JobObjectExtendedLimitInformation, &limits, sizeof limits);
		return made;
	}();
	return job;
}

// Two pipes. Both ends can be inherited, but a worker gets only those of its list.
struct Pipes
{
	Pipes()
	{
		SECURITY_ATTRIBUTES inherited{sizeof(SECURITY_ATTRIBUTES), nullptr, TRUE};
		if (::CreatePipe(&workers[0], &ours[0], &inherited, 0) == 0 || ::CreatePipe(&ours[1], &workers[1], &inherited, 0) == 0)
		{
			fail();
		}
	}

	std::array<HANDLE, 2> workers{}; // requests, answers
	std::array<HANDLE, 2> ours{};
};

// Starts a program that inherits only these handles, without a console (Ctrl-C is for its parent) or standard streams.
PROCESS_INFORMATION start(const std::wstring& path, std::array<HANDLE, 2>& handles)
{
	SIZE_T bytes = 0;
	::InitializeProcThreadAttributeList(nullptr, 1, 0, &bytes);
	std::vector<std::max_align_t> room(bytes / sizeof(std::max_align_t) + 1);
	STARTUPINFOEXW settings{};
	settings.StartupInfo.cb = sizeof settings;
	settings.StartupInfo.dwFlags = STARTF_USESTDHANDLES;
	settings.lpAttributeList = reinterpret_cast<LPPROC_THREAD_ATTRIBUTE_LIST>(room.data()); // NOLINT: what it takes
	std::wstring command =
		L"\"" + path + L"\" " + std::to_wstring(numberOf(handles[0])) + L":" + std::to_wstring(numberOf(handles[1]));
	PROCESS_INFORMATION made{};
	if (::InitializeProcThreadAttributeList(settings.lpAttributeList, 1, 0, &bytes) == 0 ||
		::UpdateProcThreadAttribute(settings.lpAttributeList, 0, PROC_THREAD_ATTRIBUTE_HANDLE_LIST, handles.data(), sizeof handles,
									nullptr, nullptr) == 0 ||
		::CreateProcessW(path.c_str(), command.data(), nullptr, nullptr, TRUE,
						 CREATE_SUSPENDED | CREATE_NO_WINDOW | EXTENDED_STARTUPINFO_PRESENT, nullptr, nullptr,
						 &settings.StartupInfo, &made) == 0)
	{
		fail();
	}
	::AssignProcessToJobObject(jobOfWorkers(), made.hProcess);
	::ResumeThread(made.hThread);
	::CloseHandle(made.hThread);
	return made;
}

} // namespace

bool sendBytes(StreamEnd to, const void* data, std::size_t size)
{
	const auto* at = static_cast<const char*>(data);
	while (size > 0)
	{
		DWORD sent = 0;
		if (::WriteFile(handleOf(to), at, static_cast<DWORD>(std::min(size, std::size_t{1} << 20U)), &sent, nullptr) == 0)
		{
			return false;
		}
		at += sent;
		size -= sent;
	}
	return true;
}

std::size_t receiveBytes(StreamEnd from, void* data, std::size_t size)
{
	DWORD got = 0;
	return ::ReadFile(handleOf(from), data, static_cast<DWORD>(std::min(size, std::size_t{1} << 20U)), &got, nullptr) != 0 ? got
																														   : 0;
}

bool waitForBytes(StreamEnd from)
{
	for (const ULONGLONG end = ::GetTickCount64() + 1000 / kWaitsASecond; ::GetTickCount64() <= end; ::Sleep(1))
	{
		DWORD bytes = 0;
		if (::PeekNamedPipe(handleOf(from), nullptr, 0, nullptr, &bytes, nullptr) == 0 || bytes > 0)
		{
			return true;
		}
	}
	return false;
}

ChildProcess::ChildProcess(const std::string& path)
{
	Pipes pipes;
	m_process = numberOf(start(nativePath(path).wstring(), pipes.workers).hProcess);
	for (const HANDLE end : pipes.workers)
	{
		::CloseHandle(end);
	}
	m_streams = {numberOf(pipes.ours[1]), numberOf(pipes.ours[0])};
}

ChildProcess::~ChildProcess()
{
	if (m_process != 0)
	{
		::TerminateProcess(handleOf(m_process), 1);
		end();
	}
}

std::size_t ChildProcess::residentBytes() const
{
	return memoryOf(handleOf(m_process)).WorkingSetSize;
}

ProcessEnd ChildProcess::end()
{
	::CloseHandle(handleOf(m_streams.from));
	::CloseHandle(handleOf(m_streams.to));
	DWORD status = 0;
	::WaitForSingleObject(handleOf(m_process), INFINITE);
	::GetExitCodeProcess(handleOf(m_process), &status);
	::CloseHandle(handleOf(m_process));
	m_process = 0;
	return {static_cast<int>(status), status == ERROR_NOT_ENOUGH_QUOTA}; // a job's limit on processor time
}

std::optional<std::string> pathOfWorker(const std::string& program)
{
	std::wstring self(32768, L'\0'); // longest path
	self.resize(::GetModuleFileNameW(nullptr, self.data(), static_cast<DWORD>(self.size())));
	const std::filesystem::path here = std::filesystem::path(self).parent_path();
	for (const std::filesystem::path& folder : {here, here / ".." / "libsamples" / "core"}) // installed, in the build folder
	{
		const std::filesystem::path path = folder / (program + ".exe");
		std::error_code ignored;
		if (std::filesystem::exists(path, ignored))
		{
			const std::u8string name = path.u8string();
			return std::string(name.begin(), name.end());
		}
	}
	return std::nullopt;
}

std::optional<WorkerStreams> takeStreams(const char* argument)
{
	::SetUnhandledExceptionFilter([](EXCEPTION_POINTERS*) -> LONG { return EXCEPTION_EXECUTE_HANDLER; }); // a crash asks nobody
	char* next = nullptr;
	const std::intptr_t from = std::strtoll(argument, &next, 10);
	return *next == ':' ? std::optional(WorkerStreams{from, std::strtoll(next + 1, nullptr, 10)}) : std::nullopt;
}

bool limitThisProcess(bool limited, std::size_t memory_bytes, int processor_s)
{
	static const HANDLE job = []
	{
		const HANDLE made = ::CreateJobObjectW(nullptr, nullptr);
		::AssignProcessToJobObject(made, ::GetCurrentProcess());
		return made;
	}();
	JOBOBJECT_EXTENDED_LIMIT_INFORMATION limits{};
	if (limited)
	{
		FILETIME ignored{};
		FILETIME user{};
		::GetProcessTimes(::GetCurrentProcess(), &ignored, &ignored, &ignored, &user);
		limits.BasicLimitInformation.LimitFlags = JOB_OBJECT_LIMIT_PROCESS_TIME | JOB_OBJECT_LIMIT_PROCESS_MEMORY;
		limits.BasicLimitInformation.PerProcessUserTimeLimit.QuadPart = // in units of 100 ns
			(static_cast<LONGLONG>(user.dwHighDateTime) << 32U) + user.dwLowDateTime + 10000000LL * processor_s;
		limits.ProcessMemoryLimit = memoryOf(::GetCurrentProcess()).PagefileUsage + memory_bytes;
	}
	return ::SetInformationJobObject(job, JobObjectExtendedLimitInformation, &limits, sizeof limits) != 0 && limited;
}

} // namespace nook
