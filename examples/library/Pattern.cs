// SPDX-License-Identifier: MIT
// A pattern in C#: mcs Pattern.cs && mono Pattern.exe
using System;
using System.Runtime.InteropServices;

static class Pattern
{
	const string Library = "libnook.so.1";

	[StructLayout(LayoutKind.Sequential)]
	unsafe struct NookArray
	{
		public IntPtr Data;
		public int Type;
		public int Dimensions;
		public fixed ulong Shape[4];
	}

	[DllImport(Library)] static extern int nook_require(uint abi);
	[DllImport(Library)] static extern IntPtr nook_error();
	[DllImport(Library)] static extern int nook_options_create(out IntPtr options);
	[DllImport(Library)] static extern int nook_options_set(IntPtr options, string name, string value);
	[DllImport(Library)] static extern void nook_options_destroy(IntPtr options);
	[DllImport(Library)] static extern int nook_run_pattern(IntPtr options, out IntPtr result);
	[DllImport(Library)] static extern int nook_result_array(IntPtr result, string name, out NookArray array);
	[DllImport(Library)] static extern void nook_result_destroy(IntPtr result);

	static void Check(int status)
	{
		if (status != 0)
		{
			throw new Exception(Marshal.PtrToStringAnsi(nook_error()));
		}
	}

	static unsafe void Main()
	{
		Check(nook_require(1));
		IntPtr options, result;
		Check(nook_options_create(out options));
		Check(nook_options_set(options, "domain", "disk"));
		Check(nook_options_set(options, "count", "9"));
		Check(nook_run_pattern(options, out result));
		NookArray points;
		Check(nook_result_array(result, "points", out points));
		double* numbers = (double*)points.Data;
		for (ulong i = 0; i < points.Shape[0]; i++)
		{
			Console.WriteLine("{0:F4} {1:F4}", numbers[2 * i], numbers[2 * i + 1]);
		}
		nook_result_destroy(result);
		nook_options_destroy(options);
	}
}
