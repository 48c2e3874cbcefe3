kenaf_fuzzer(run_file_fuzz SOURCE run_file_fuzz.cpp LIBRARIES kenaf_runs)
