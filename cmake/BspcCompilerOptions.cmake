# What every target of the project is compiled with. Decoders repeat floating-point arithmetic of
# the encoder, so contraction into fused operations and fast-math are off everywhere.
set(CMAKE_CXX_STANDARD 17)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_CXX_VISIBILITY_PRESET hidden)
set(CMAKE_VISIBILITY_INLINES_HIDDEN ON)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)

if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
endif()

# Without -Wpsabi: vectors are passed between inline functions only, so their ABI does not matter.
add_library(bspc_compiler_options INTERFACE)
target_compile_options(bspc_compiler_options INTERFACE
  -Wall -Wextra -Wconversion -Wshadow -Wno-psabi -ffp-contract=off -fno-fast-math
  $<$<BOOL:${BSPC_WARNINGS_AS_ERRORS}>:-Werror>
)
if(BSPC_BUILD_FUZZERS)
  target_compile_options(bspc_compiler_options INTERFACE -fsanitize=fuzzer-no-link)
endif()
if(BSPC_SANITIZE)
  target_compile_options(bspc_compiler_options INTERFACE
    -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer
    # g++ warns of members of empty std::optional in instrumented code.
    $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>
  )
  target_link_options(bspc_compiler_options INTERFACE -fsanitize=address,undefined)
endif()
if(BSPC_SANITIZE_THREADS)
  target_compile_options(bspc_compiler_options INTERFACE
    -fsanitize=thread -fno-omit-frame-pointer
    $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>
  )
  target_link_options(bspc_compiler_options INTERFACE -fsanitize=thread)
endif()
if(BSPC_COVERAGE)
  target_compile_options(bspc_compiler_options INTERFACE --coverage -fprofile-update=atomic)
  target_link_options(bspc_compiler_options INTERFACE --coverage)
endif()
