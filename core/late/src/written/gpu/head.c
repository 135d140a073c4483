
/* Three languages: OpenCL C 1.2 with double precision, without options that loosen arithmetic; CUDA, with --fmad=false; and C99,
   with -ffp-contract=off, where a kernel is a loop over the members. sin, cos, exp and log are those of the device, the other
   operations those of the library. */
#ifndef LIESTEP_FUNCTION
#if defined(__OPENCL_VERSION__)
#pragma OPENCL EXTENSION cl_khr_fp64 : enable
#pragma OPENCL FP_CONTRACT OFF
#define LIESTEP_FUNCTION static
#define LIESTEP_TABLE __constant
#define LIESTEP_KERNEL __kernel void
#define LIESTEP_GLOBAL __global
#define LIESTEP_EACH(i, members) const ulong i = get_global_id(0); if (i < members)
typedef ulong liestep_count;
#elif defined(__CUDACC__) || defined(__CUDA__)
#define LIESTEP_FUNCTION static __device__
#define LIESTEP_TABLE static __constant__ const
#define LIESTEP_KERNEL extern "C" __global__ void
#define LIESTEP_GLOBAL
#define LIESTEP_EACH(i, members) const liestep_count i = (liestep_count)blockIdx.x * blockDim.x + threadIdx.x; if (i < members)
typedef unsigned long long liestep_count;
#else
#include <math.h>
#define LIESTEP_FUNCTION static
#define LIESTEP_TABLE static const
#define LIESTEP_KERNEL void
#define LIESTEP_GLOBAL
#define LIESTEP_EACH(i, members) for (liestep_count i = 0; i < members; i++)
typedef unsigned long long liestep_count;
#endif
#if defined(__OPENCL_VERSION__)
#define LIESTEP_POINTER __constant const double *
#else
#define LIESTEP_POINTER const double *
#endif
#endif
