kenaf_fuzzer(candrives_fuzz SOURCE ${CMAKE_CURRENT_LIST_DIR}/candrives_fuzz.cpp LIBRARIES kenaf_candrives)
kenaf_fuzzer(fault_script_fuzz SOURCE fault_script_fuzz.cpp LIBRARIES kenaf_candrives)
