// The places of the robot's two cameras. A picture is MJPEG, which a browser shows by itself.
import { address } from "./connection.js";

const PLACES = ["front", "top"];
const TITLES = { front: "Front camera", top: "Bird's-eye camera" };

export function createPictures() {
  const section = document.getElementById("pictures");
  return {
    show(cameras) {
      section.replaceChildren(...PLACES.map((name, i) => {
        const figure = document.createElement("figure"), caption = document.createElement("figcaption");
        const camera = cameras[i];
        caption.textContent = camera ? camera : TITLES[name];
        if (camera) {
          const picture = document.createElement("img");
          picture.src = address(`/camera/${encodeURIComponent(camera)}.mjpg`);
          picture.alt = `Picture of the camera ${camera}`;
          figure.append(picture, caption);
        } else {
          const none = document.createElement("p");
          none.className = "none";
          none.textContent = "no picture";
          figure.append(caption, none);
        }
        return figure;
      }));
    },
  };
}
