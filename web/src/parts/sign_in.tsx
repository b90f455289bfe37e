import { useState } from "preact/hooks";
import { restarted, session, signIn } from "../state";

export function SignIn() {
  const [token, type] = useState("");
  const [problem, tell] = useState("");
  const send = (event: Event): void => {
    event.preventDefault();
    signIn(token.trim()).catch((error: Error) => tell(error.message));
  };
  if (!session.value?.bench)
    return (
      <section class="empty">
        <h1>This address was used before</h1>
        <p>The address that imunoise open prints is good for one browser. Run it again for another one.</p>
      </section>
    );
  return (
    <form class="empty" onSubmit={send}>
      <h1>Sign in</h1>
      <p>{restarted.value && "imunoised was started again, and asks once more. "}The token is in the file that imunoised was started with (<span class="mono">--tokens</span>): the second word of a line.</p>
      <label for="token">Token</label>
      <input id="token" type="password" autocomplete="current-password" required value={token}
        onInput={(event) => type(event.currentTarget.value)} />
      <button type="submit" class="main">Sign in</button>
      {problem && <p class="alarm" role="alert">{problem}</p>}
    </form>
  );
}
