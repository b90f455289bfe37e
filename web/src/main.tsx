import { render } from "preact";
import { App } from "./app";
import { start } from "./state";
import "../../study/figure/assets/palette.css";
import "../../study/figure/assets/plot.css";
import "./page.css";

const root = document.getElementById("app");
if (root) render(<App />, root);
void start();
