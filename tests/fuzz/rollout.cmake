foreach(fuzzer manoeuvre_fuzz replay_fuzz)
  kenaf_fuzzer(${fuzzer} SOURCE ${CMAKE_CURRENT_LIST_DIR}/${fuzzer}.cpp LIBRARIES kenaf_rollout)
endforeach()
