// What is known of the chosen robot's driving, in a word for its colour and a sentence. Pure.

// Whether this page stopped the time, also before it was loaded anew.
export const isPausedHere = ({ pausedBy, mine }) => mine.has(pausedBy?.operator);
// Who stopped the time, as the server has it: the number of an operator's page, or the name of a program.
export function whoPaused(world) {
  const { pausedBy } = world;
  if (pausedBy?.operator) return isPausedHere(world) ? "you" : "another page";
  return pausedBy?.program ? `the program ${pausedBy.program}` : "somebody";
}

// `mine`: the robot, if it is yours; `lost`: the name of the one that was yours when the link was lost; `moves`: keys or stick order a
// motion. `lookingBack`: what is shown was. `pointing`: keys and clicks point at a place.
export function describe({ robot, mine, holder, lost, world, isHeard, moves, lookingBack, pointing }) {
  if (!isHeard) {
    const yours = `${lost} stops by itself ${world.operatorSilence_s} s after the last word that reached it`;
    return { state: "lost", text: lost ? `No link: ${yours}` : "No link: what is shown is old" };
  }
  if (!robot) {
    return { state: "none", text: world.robots.size ? "Not driving" : "No robot is in the world: place one, or start a program" };
  }
  const { name, placed } = robot.about;
  if (mine && world.paused) return { state: "paused", text: `${name} is yours; the world is paused by ${whoPaused(world)}` };
  if (mine && lookingBack) return { state: "paused", text: `${name} stands: nothing drives while you look back` };
  if (mine && pointing) return { state: "paused", text: `${name} stands: you point at a place now. Esc ends that` };
  if (mine && moves) return { state: "driving", text: `Driving ${name}` };
  if (mine) return { state: "held", text: `${name} is at rest: hold W, A, S, D or the stick to drive` };
  const paused = world.paused ? `; the world is paused by ${whoPaused(world)}` : "";
  if (holder) return { state: "other", text: `Another operator has ${name}: take over once that one lets go${paused}` };
  if (lost) return { state: "none", text: `The link was lost, so the server let go of ${lost}. Take over to drive on${paused}` };
  if (placed) return { state: "none", text: `Not driving: ${name} is at rest${paused}` };
  const isSilent = robot.now?.client?.silent;
  return { state: "none", text: `Not driving: ${isSilent ? `the program of ${name} is silent, and it stands` : `a program commands ${name}`}${paused}` };
}
