// SPDX-License-Identifier: GPL-3.0-or-later
// Blocks of megabytes in huge pages, of the program alone: levels and pictures are lists of tens of megabytes that are filled once,
// and where Linux gives huge pages to those who ask (transparent_hugepage: madvise), a page of 4 KiB at a time takes longer than
// filling it.
#include <cstddef>
#include <cstdlib>
#include <new>

#include <sys/mman.h>

namespace
{

constexpr std::size_t kHugePage = std::size_t{1} << 21U;
constexpr std::size_t kLarge = kHugePage;

void* allocate(std::size_t size)
{
	if (size < kLarge || size > static_cast<std::size_t>(-1) - kHugePage)
	{
		return std::malloc(size > 0 ? size : 1);
	}
	void* const block = std::aligned_alloc(kHugePage, (size + kHugePage - 1) / kHugePage * kHugePage);
	if (block != nullptr)
	{
		::madvise(block, size / kHugePage * kHugePage, MADV_HUGEPAGE); // no more than is asked for: a tile's memory is told before
	}
	return block;
}

} // namespace

void* operator new(std::size_t size)
{
	for (;;)
	{
		if (void* const block = allocate(size))
		{
			return block;
		}
		const std::new_handler handler = std::get_new_handler();
		if (handler == nullptr)
		{
			throw std::bad_alloc();
		}
		handler();
	}
}

void operator delete(void* block) noexcept
{
	std::free(block);
}

void operator delete(void* block, std::size_t) noexcept
{
	std::free(block);
}
