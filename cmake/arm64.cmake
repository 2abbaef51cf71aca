# Cross build for arm64 (Debian's aarch64 compiler). Libraries come from a folder that holds an
# arm64 Debian's /usr: POLHODE_ARM64_SYSROOT, which scripts/test_arm64.sh fills. Without it, the
# machine's own multiarch folders are searched. Programs run under QEMU's user emulation.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
set(CMAKE_LIBRARY_ARCHITECTURE aarch64-linux-gnu)

set(POLHODE_ARM64_SYSROOT "$ENV{POLHODE_ARM64_SYSROOT}" CACHE PATH "Folder with arm64 libraries")
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES POLHODE_ARM64_SYSROOT)

find_program(POLHODE_QEMU_AARCH64 NAMES qemu-aarch64 qemu-aarch64-static)
if(POLHODE_ARM64_SYSROOT)
  set(CMAKE_SYSROOT ${POLHODE_ARM64_SYSROOT})
  set(CMAKE_FIND_ROOT_PATH ${POLHODE_ARM64_SYSROOT})
  set(ENV{PKG_CONFIG_SYSROOT_DIR} ${POLHODE_ARM64_SYSROOT})
  set(ENV{PKG_CONFIG_LIBDIR}
    ${POLHODE_ARM64_SYSROOT}/usr/lib/aarch64-linux-gnu/pkgconfig:${POLHODE_ARM64_SYSROOT}/usr/share/pkgconfig)
  set(CMAKE_CROSSCOMPILING_EMULATOR ${POLHODE_QEMU_AARCH64};-L;${POLHODE_ARM64_SYSROOT})
else()
  set(ENV{PKG_CONFIG_LIBDIR} /usr/lib/aarch64-linux-gnu/pkgconfig:/usr/share/pkgconfig)
  set(CMAKE_CROSSCOMPILING_EMULATOR ${POLHODE_QEMU_AARCH64};-L;/usr/aarch64-linux-gnu)
endif()

set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)

# FindHDF5 asks the compiler wrapper, which is a program of the other machine: say where it is.
if(POLHODE_ARM64_SYSROOT)
  set(polhode_arm64_usr ${POLHODE_ARM64_SYSROOT}/usr)
else()
  set(polhode_arm64_usr /usr)
endif()
set(HDF5_C_LIBRARY_hdf5 ${polhode_arm64_usr}/lib/aarch64-linux-gnu/hdf5/serial/libhdf5.so CACHE FILEPATH "")
set(HDF5_C_INCLUDE_DIR ${polhode_arm64_usr}/include/hdf5/serial CACHE PATH "")
set(HDF5_C_COMPILER_EXECUTABLE HDF5_C_COMPILER_EXECUTABLE-NOTFOUND CACHE FILEPATH "")
