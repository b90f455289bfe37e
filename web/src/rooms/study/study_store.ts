// One study: what it is, what is done to it, and the job that works on it.
import { computed, signal } from "@preact/signals";
import { get, over, post, type Refused } from "../../api/client";
import type { Job, Posts, Study } from "../../api/schema";
import { jobs, listStudies, mayChange } from "../../state";

export class StudyStore {
  readonly study = signal<Study | null>(null);
  readonly problem = signal("");
  readonly preview = signal(""); // a term
  readonly job = signal<string>("");
  readonly working = computed(() => {
    const job = jobs.value.get(this.job.value);
    return job && !over(job) ? job : null;
  });
  readonly busy = signal(false); // with a change; a search for what is missing is no reason to wait
  private sought: Promise<void> = Promise.resolve();
  private closed = false;

  constructor(readonly name: string) {}

  close(): void { this.closed = true; }

  async load(): Promise<void> {
    await this.guarded(async () => {
      this.study.value = await get("/v1/studies/{study}", { study: this.name });
    });
    this.resume();
  }

  /** Compares the model with the known effects. */
  seek(): void {
    if (!mayChange.value) return;
    this.sought = this.follows("/v1/studies/{study}/candidates", {}).catch((error: Refused) => { this.problem.value = error.message; });
  }
  add = (term: string): Promise<boolean> => this.changes("/v1/studies/{study}/add", { term });
  tryModel = (model: string): Promise<boolean> => this.changes("/v1/studies/{study}/try", { model });
  undo = (): Promise<boolean> => this.changes("/v1/studies/{study}/undo", {});
  redo = (): Promise<boolean> => this.changes("/v1/studies/{study}/redo", {});
  back = (steps: number): Promise<boolean> => this.changes("/v1/studies/{study}/undo", {}, steps);

  async branch(name: string): Promise<boolean> {
    const done = await this.changes("/v1/studies/{study}/branch", { name });
    await listStudies();
    return done;
  }

  /** Draws what a term would do. What a candidate promises is known already. */
  async foresee(term: string): Promise<void> {
    const known = this.study.value?.diagnosis?.candidates.some((one) => one.term === term && one.next);
    if (!known && term) {
      const study = this.study.value;
      const done = await this.changes("/v1/studies/{study}/preview", { term });
      this.study.value = study;
      if (!done) return;
    }
    this.preview.value = term;
  }

  // A new model has not been compared with the known effects. What is sought for the one before is given up.
  private async changes<Path extends keyof Posts>(path: Path, body: Posts[Path]["body"], times = 1): Promise<boolean> {
    this.busy.value = true;
    this.preview.value = "";
    await this.guarded(async () => {
      const job = this.working.value;
      if (job?.operation === "candidates") await post("/v1/jobs/{job}/cancel", { job: job.job });
      await this.sought;
      for (let i = 0; i < times; ++i) await this.follows(path, body);
    });
    void listStudies().catch(() => undefined);
    this.resume();
    return !this.problem.value;
  }

  private resume(): void {
    if (this.study.value && !this.study.value.diagnosis && !this.closed) this.seek();
  }

  private async follows<Path extends keyof Posts>(path: Path, body: Posts[Path]["body"]): Promise<void> {
    let job = (await post(path, { study: this.name }, body)) as Job;
    this.job.value = job.job;
    jobs.value = new Map(jobs.value).set(job.job, job);
    while (!over(job) && !this.closed) {
      await this.news(job.job);
      job = await get("/v1/jobs/{job}", { job: job.job });
    }
    jobs.value = new Map(jobs.value).set(job.job, { ...job });
    if (job.state === "failed") throw new Error(job.error);
    if (job.result && path !== "/v1/studies/{study}/branch") this.study.value = job.result;
  }

  // Until the stream tells that the job is over, or a while later: streams may break.
  private news(job: string): Promise<void> {
    return new Promise((go) => {
      const end = (): void => { clearTimeout(timer); stop(); go(); };
      const timer = setTimeout(end, 300);
      const stop = jobs.subscribe((all) => {
        const now = all.get(job);
        if (now && over(now)) queueMicrotask(end);
      });
    });
  }

  private async guarded(work: () => Promise<void>): Promise<void> {
    this.busy.value = true;
    this.problem.value = "";
    try {
      await work();
    } catch (error) {
      this.problem.value = (error as Refused).message;
    } finally {
      this.busy.value = false;
    }
  }
}
