kenaf_fuzzer(urdf_fuzz SOURCE ${CMAKE_CURRENT_LIST_DIR}/urdf_fuzz.cpp LIBRARIES kenaf_describe)
