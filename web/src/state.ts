// What all rooms share: who is here, where, and what the service tells.
import { computed, signal } from "@preact/signals";
import { get, post, Refused } from "./api/client";
import { watch } from "./api/events";
import type { CampaignState, InputList, Job, LiveReplicate, RejectedFile, Session, StudySummary } from "./api/schema";

export const session = signal<Session | null>(null);
export const connected = signal(true);
export const place = signal<readonly string[]>([]);
export const campaigns = signal<ReadonlyMap<string, CampaignState> | null>(null);
export const rejected = signal<readonly RejectedFile[]>([]); // campaign files
export const live = signal<ReadonlyMap<string, LiveReplicate>>(new Map());
export const jobs = signal<ReadonlyMap<string, Job>>(new Map());
export const studies = signal<readonly StudySummary[] | null>(null);
export const inputs = signal<InputList["inputs"]>([]);
export const trouble = signal<string>("");
export const restarted = signal(false); // the service, since somebody signed in

export const mayChange = computed(() => session.value?.role === "operator");
export const knownHere = computed(() => session.value !== null && session.value.role !== "role_unspecified");

const with_ = <Value>(map: ReadonlyMap<string, Value>, name: string, value: Value): ReadonlyMap<string, Value> =>
  new Map(map).set(name, value);

export const go = (...words: string[]): void => {
  location.hash = "#/" + words.map(encodeURIComponent).join("/");
};

function follow(): void {
  const path = location.hash.replace(/^#\/?/, "").split("?")[0] ?? "";
  place.value = path.split("/").filter(Boolean).map(decodeURIComponent);
}

// The token of the address opens a session, and leaves the address.
async function redeem(): Promise<void> {
  const [path, words] = location.hash.split("?");
  const token = new URLSearchParams(words).get("token");
  if (!token) return;
  await post("/v1/session", {}, { token }).catch((error: Refused) => {
    if (error.status !== 401) throw error;
  });
  history.replaceState(null, "", path || "#/");
}

export async function signIn(token: string): Promise<void> {
  session.value = await post("/v1/session", {}, { token });
  restarted.value = false;
  await begin();
}

export async function listStudies(): Promise<void> {
  studies.value = (await get("/v1/studies")).studies;
}

/** Campaigns come and go with their files, which no event tells. */
export async function listCampaigns(): Promise<void> {
  const list = await get("/v1/campaigns");
  campaigns.value = new Map(list.campaigns.map((one) => [one.campaign?.name ?? "", one]));
  rejected.value = list.rejected;
}

async function look(): Promise<void> {
  inputs.value = (await get("/v1/inputs")).inputs;
  await listStudies();
  if (!session.value?.bench) return;
  await listCampaigns();
  const now = (await get("/v1/live")).replicates;
  live.value = new Map(now.map((one) => [one.campaign, one]));
}

// Sessions end with the program: one that was started again knows none.
function forget(): void {
  connected.value = true;
  if (!knownHere.value || !session.value) return;
  restarted.value = true;
  session.value = { ...session.value, role: "role_unspecified" };
}

let watching = false;

async function begin(): Promise<void> {
  if (!knownHere.value) return;
  await look();
  if (watching) return;
  watching = true;
  watch((news) => {
    if ("connected" in news) {
      const back = news.connected && !connected.value;
      connected.value = news.connected;
      if (back) void look().catch(() => undefined);
      return;
    }
    if ("stranger" in news) {
      forget();
      return;
    }
    if (news.campaign) {
      campaigns.value = with_(campaigns.value ?? new Map(), news.campaign.campaign?.name ?? "", news.campaign);
      if (!news.campaign.recording) {
        const rest = new Map(live.value);
        rest.delete(news.campaign.campaign?.name ?? "");
        live.value = rest;
      }
    }
    if (news.live) live.value = with_(live.value, news.live.campaign, news.live);
    if (news.job) jobs.value = with_(jobs.value, news.job.job, news.job);
  });
}

export async function start(): Promise<void> {
  addEventListener("hashchange", follow);
  try {
    await redeem();
    session.value = await get("/v1/session");
    follow();
    await begin();
  } catch (error) {
    trouble.value = (error as Error).message;
    setTimeout(() => void start(), 2000);
    return;
  }
  trouble.value = "";
}
