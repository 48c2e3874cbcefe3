from kenaf.hrt_sim import *
